// I27: each strobe leads to exactly one execution of its function, and the program goes on only on a FIN that
// was raised for that strobe. Watches the kernel's logic task, and the PLC's devices scan by scan.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <string>

#include "emulator_models/device_memory.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

class FunctionMonitor final : public kernel_mocks::LogicTaskObserver {
 public:
  explicit FunctionMonitor(ltsim::World& world) : world_(world) {}

  /// The kernel begins a part program: what an earlier one left without its FIN counts no more.
  void program_begins();
  /// After World::run(), when the last program has come to its end.
  void check_at_end();

  void strobe_raised(kernel_mocks::FunctionKind kind, std::uint16_t number) noexcept override;
  void finished(kernel_mocks::FunctionKind kind, std::uint16_t number,
                std::chrono::nanoseconds duration) noexcept override;

  /// From here on the kernel may have been told of a FIN that was none: nothing is judged any more.
  void excuse() noexcept;

  /// A scan has ended.
  void scanned(const emulator_models::DeviceMemory& memory);
  /// Its process was killed: what it was doing is not done.
  void plc_is_dead() noexcept;

 private:
  struct Function {
    char letter;
    std::uint16_t number;
    auto operator<=>(const Function&) const = default;
  };
  /// Since the last FIN that the kernel took for it, or since the begin of the program.
  struct Counts {
    unsigned strobes = 0;
    unsigned executed = 0;
  };
  /// What the PLC sees of one kind of function.
  struct Seen {
    bool under_way = false;  ///< its strobe is on, and counts
    Function function{};
  };

  [[nodiscard]] static std::string name(const Function& function);

  ltsim::World& world_;
  std::map<Function, Counts> counts_;
  std::array<Seen, 3> seen_{};
  bool fin_ = false;
  bool is_excused_ = false;
};

}  // namespace scenarios
