// I27: each strobe leads to exactly one execution of its function, and the program goes on only on a FIN that
// was raised for that strobe. Watches the kernel's logic task and the PLC's machine program at once.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>

#include "emulator_models/machine_program.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

class FunctionMonitor final : public kernel_mocks::LogicTaskObserver,
                              public emulator_models::MachineObserver {
 public:
  explicit FunctionMonitor(ltsim::World& world) : world_(world) {}

  /// After World::run(), when the program has come to its end.
  void check_at_end();

  void strobe_raised(kernel_mocks::FunctionKind kind, std::uint16_t number) noexcept override;
  void finished(kernel_mocks::FunctionKind kind, std::uint16_t number,
                std::chrono::nanoseconds duration) noexcept override;
  void action_started(emulator_models::FunctionKind kind, std::uint16_t number) noexcept override;
  void action_finished(emulator_models::FunctionKind kind, std::uint16_t number) noexcept override;

 private:
  struct Function {
    char letter;
    std::uint16_t number;
    auto operator<=>(const Function&) const = default;
  };
  struct Counts {
    unsigned strobes = 0;
    unsigned started = 0;
    unsigned executed = 0;
    unsigned acknowledged = 0;
  };

  [[nodiscard]] static std::string name(const Function& function);
  void check_acknowledged(const Function& function, const Counts& counts);

  ltsim::World& world_;
  std::map<Function, Counts> counts_;
};

}  // namespace scenarios
