// The PLC program of the built-in machine: takes the M, S and T functions of the kernel, works the spindle,
// the coolant and the tool changer, and answers FIN (README.md has the contract).
//
//            strobe rises            all strobed done           all strobes low
//   idle ----------------> executing ----------------> finished ----------------> idle
//                              | reset, alarm                        FIN is on in `finished` only
//                              +-------------> abandoned ---------------------> idle
//
// Invariants
//   I1  FIN rises only when every function whose strobe is on is done, by its own feedback.
//   I2  each rise of a strobe starts its function once; code or value is read at that moment only.
//   I3  the two spindle directions are never on together; a reversal goes through standstill.
//   I4  after an alarm no output comes on again before a reset.
//
// The program keeps its state in members and sees the machine only through the device memory, once a scan.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "emulator_models/device_memory.hpp"
#include "emulator_models/special_devices.hpp"

namespace emulator_models {

enum class FunctionKind : std::uint8_t { m, s, t };

/// Told what the program does, from within the scan: must not call the PLC back.
class MachineObserver {
 public:
  virtual ~MachineObserver() = default;

  virtual void action_started(FunctionKind /*kind*/, std::uint16_t /*number*/) noexcept {}
  /// Not called for an action that a reset, an alarm or a withdrawn strobe cut short.
  virtual void action_finished(FunctionKind /*kind*/, std::uint16_t /*number*/) noexcept {}

 protected:
  MachineObserver() = default;
  MachineObserver(const MachineObserver&) = default;
  MachineObserver& operator=(const MachineObserver&) = default;
};

/// D120.
enum class MachineAlarm : std::uint16_t {
  none = 0,
  emergency_stop = 1,   ///< the chain is open
  door_open = 2,        ///< the door is open while the spindle is to turn
  action_time_out = 3,  ///< the feedback of a step did not come within step_time_max
};

class MachineProgram {
 public:
  /// Three times the longest step of the plant and more: the tool change takes 1.2 s.
  static constexpr std::chrono::seconds step_time_max{5};

  /// @param observer  must outlive the program; nullptr = nobody listens
  explicit MachineProgram(MachineObserver* observer = nullptr) noexcept;

  /// One run of the program, the third phase of a scan.
  /// @param memory  the image: inputs latched, outputs not written yet; M8002 tells the first scan of RUN
  /// @param now     the same for the whole scan
  void run(DeviceMemory& memory, SteadyTime now) noexcept;

 private:
  enum class Handshake : std::uint8_t { idle, executing, finished, abandoned };
  enum class Progress : std::uint8_t { none, running, done };
  /// A piece of an action that ends with one feedback.
  enum class Step : std::uint8_t {
    coolant_off,
    spindle_off,
    spindle_clockwise,
    spindle_counter_clockwise,
    flood_on,
    mist_on,
    change_tool,
    clamp_tool,
    select_tool,
    set_speed,
  };

  struct Function {
    FunctionKind kind = FunctionKind::m;
    protocol::fx::Device value_device;
    protocol::fx::Device strobe_device;
    Progress progress = Progress::none;
    std::uint16_t number = 0;
    std::size_t step_index = 0;
    SteadyTime step_since{};
  };

  class Image;

  [[nodiscard]] static std::span<const Step> steps_of(FunctionKind kind, std::uint16_t number) noexcept;

  void watch_safety(Image& image) noexcept;
  void run_handshake(Image& image, SteadyTime now) noexcept;
  void start(Function& function, const Image& image, SteadyTime now) noexcept;
  void go_on(Function& function, Image& image, SteadyTime now) noexcept;
  void withdraw(Function& function, Image& image) noexcept;
  [[nodiscard]] bool step_is_done(Step step, std::uint16_t number, Image& image) noexcept;
  [[nodiscard]] bool spindle_turns(Image& image, protocol::fx::Device direction,
                                   protocol::fx::Device opposite) noexcept;
  void raise_alarm(MachineAlarm alarm, Image& image) noexcept;
  void abandon(Image& image) noexcept;
  void publish(Image& image) const noexcept;

  MachineObserver* observer_;
  /// In the order in which functions of one handshake start: the M6 of a block finds its T, the M3 its S.
  std::array<Function, 3> functions_;
  Handshake handshake_ = Handshake::idle;
  MachineAlarm alarm_ = MachineAlarm::none;
  bool has_run_ = false;
};

}  // namespace emulator_models
