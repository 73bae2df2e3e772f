#include "tests/scenarios/machine/machine_scene.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "emulator_models/emulator_handler.hpp"
#include "kernel_mocks/fx_driver.hpp"
#include "kernel_mocks/nc_parser.hpp"
#include "kernel_mocks/part_program_runner.hpp"
#include "kernel_mocks/plc_signals.hpp"
#include "protocol/shared_memory_port_manager.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace scenarios {
namespace {

using namespace std::chrono_literals;
using emulator_models::MachineToolFailure;
using emulator_models::MachineToolPlant;
using protocol::PaperOptions;

constexpr auto scan_period = 10ms;
constexpr unsigned programs_count = 4;
constexpr unsigned blocks_in_program = 8;
constexpr unsigned hands_steps = 60;
constexpr std::uint64_t points_max = 20'000'000;

constexpr std::array blocks{"M3 S1500", "M4 S800", "M13 S1000", "M14",   "M5",         "M19",
                            "M8",       "M7",      "M9",        "T2 M6", "T5 M6",      "T8 M6",
                            "T0 M6",    "M10",     "M11",       "S2500", "G0 Z-20",    "G0 Z0",
                            "T5",       "G4 P1",   "M3 T2",     "M9 M5", "G1 X3 F900", "G1 X0 F900"};

/// Who has let the strobes fall takes FIN for low: the kernel that forgets the last step of the handshake.
class ImpatientLink final : public kernel_mocks::PlcLink {
 public:
  explicit ImpatientLink(kernel_mocks::PlcLink& link) noexcept : link_{link} {}

  tl::expected<Status, kernel_mocks::FxDriverError> status() noexcept override {
    auto status = link_.status();
    if (status && strobes_are_low_) status->signals &= ~kernel_mocks::signals::fin;
    return status;
  }
  Done read_bytes(Device first, std::span<std::byte> into) noexcept override {
    return link_.read_bytes(first, into);
  }
  Done write_bytes(Device first, std::span<const std::byte> bytes) noexcept override {
    using namespace kernel_mocks::signals;
    if (first == strobe_byte)
      strobes_are_low_ = (bytes.front() & (strobe_m | strobe_s | strobe_t)) == std::byte{0};
    return link_.write_bytes(first, bytes);
  }
  Done force(Device device, bool on) noexcept override { return link_.force(device, on); }

 private:
  kernel_mocks::PlcLink& link_;
  bool strobes_are_low_ = true;
};

/// Strobes are pulses, and whoever has had one is done: the kernel without a handshake.
class PulsingLink final : public kernel_mocks::PlcLink {
 public:
  static constexpr auto pulse = 4 * scan_period;

  explicit PulsingLink(kernel_mocks::PlcLink& link) noexcept : link_{link} {}

  tl::expected<Status, kernel_mocks::FxDriverError> status() noexcept override {
    auto status = link_.status();
    if (status && is_raised_) status->signals |= kernel_mocks::signals::fin;
    return status;
  }
  Done read_bytes(Device first, std::span<std::byte> into) noexcept override {
    return link_.read_bytes(first, into);
  }
  Done write_bytes(Device first, std::span<const std::byte> bytes) noexcept override {
    using namespace kernel_mocks::signals;
    if (first != strobe_byte) return link_.write_bytes(first, bytes);
    constexpr std::byte strobes = strobe_m | strobe_s | strobe_t;
    const std::array low{bytes.front() & ~strobes};
    const bool is_raised = bytes.front() != low.front();
    if (is_raised && !is_raised_) {
      if (auto done = link_.write_bytes(first, bytes); !done) return done;
      std::this_thread::sleep_for(pulse);
    }
    is_raised_ = is_raised;
    return link_.write_bytes(first, low);
  }
  Done force(Device device, bool on) noexcept override { return link_.force(device, on); }

 private:
  kernel_mocks::PlcLink& link_;
  std::atomic<bool> is_raised_{false};  ///< as the kernel has it
};

kernel_mocks::Program drawn_program(ltsim::World& world) {
  std::string text = "%\n";
  for (unsigned i = 0; i < blocks_in_program; ++i)
    text += std::string{blocks[world.choose("block", blocks.size())]} + '\n';
  return kernel_mocks::parse_program(text + "M30\n%").value();
}

/// The kernel: one part program after the other, whatever becomes of them.
void run_kernel(ltsim::World& world, const PaperOptions& paper, FunctionMonitor& functions,
                const ShiftSetup& setup) {
  protocol::SharedMemoryPortManager ports{paper};
  const auto port = ports.port("handoff");
  if (!port) return;
  kernel_mocks::FxDriver driver{**port, {}};
  if (!driver.connect()) return;
  kernel_mocks::DirectLink link{driver};
  ImpatientLink impatient{link};
  PulsingLink pulsing{link};
  kernel_mocks::PlcLink* used = &link;
  if (setup.fin_wait == FinWait::none) used = &impatient;
  if (setup.strobe_hold == StrobeHold::fixed_time) used = &pulsing;
  kernel_mocks::LogicTask logic_task{
      *used, {.poll_interval = 40ms, .fin_timeout = 20s, .ready_timeout = 6s}, &functions};
  kernel_mocks::OperatorPanel panel;
  using enum kernel_mocks::OperatorEvent;
  // Who is always disturbed gets nowhere: in some shifts nobody touches the panel.
  const bool operator_is_busy = world.choose("operator-busy", 2) != 0;
  kernel_mocks::RandomOperator buttons{
      {feed_hold, cycle_start, reset, abort, emergency_stop, plc_stop, plc_run},
      3s,
      [&](std::uint32_t bound) { return static_cast<std::uint32_t>(world.choose("button", bound)); }};
  for (unsigned i = 0; i < programs_count; ++i) {
    kernel_mocks::PartProgramRunner runner{
        logic_task, {.panel = &panel, .operator_ = operator_is_busy ? &buttons : nullptr}};
    functions.program_begins();
    (void)runner.run(drawn_program(world));
    std::this_thread::sleep_for(1s);
    (void)logic_task.set_plc_running(true);
  }
}

/// What people and wear do to the machine.
void lay_hands_on(ltsim::World& world, MachineToolPlant& plant, const std::atomic<bool>& done) {
  if (world.choose("hands-busy", 2) == 0) return;
  std::optional<MachineToolFailure> failure;
  bool button = false;
  bool pulled = false;
  bool pressed = false;
  for (unsigned i = 0; i < hands_steps && !done.load(); ++i) {
    std::this_thread::sleep_for(700ms);
    switch (world.choose("hand", 12)) {
      case 1:
        plant.set_door_button_pressed(button = !button);
        break;
      case 2:
        plant.set_door_pulled_open(pulled = !pulled);
        break;
      case 3:
        plant.set_emergency_stop_pressed(pressed = !pressed);
        break;
      case 4:
      case 5:
        if (failure) {
          plant.set_failure(*failure, false);
          failure.reset();
        } else {
          failure = static_cast<MachineToolFailure>(
              world.choose("failure", emulator_models::machine_tool_failures_count));
          plant.set_failure(*failure, true);
        }
        break;
      default:
        break;
    }
  }
}

}  // namespace

void run_shift(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
               const ShiftSetup& setup) {
  PaperOptions paper;
  paper.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  name_regions(world, "handoff", paper);
  world.set_points_max(points_max);
  FunctionMonitor functions{world};
  WatchedMachine machine{world, program, functions, scan_period, setup.service};
  machine.judge_only(setup.only_rule);
  protocol::SlaveSharedMemoryWrapper slave{"handoff", paper};
  emulator_models::EmulatorHandler handler{slave, machine.port()};
  std::atomic<bool> done{false};

  world.process("kernel").start("main", [&] {
    run_kernel(world, paper, functions, setup);
    done.store(true);
    handler.request_stop();
    machine.request_stop();
  });
  world.process("emulator").start("port", [&] {
    if (slave.open()) handler.run();
  });
  world.process("emulator").start("scan", [&] { machine.scan(); });
  world.process("shop").start("hands", [&] { lay_hands_on(world, machine.plant(), done); });
  world.run();
}

}  // namespace scenarios
