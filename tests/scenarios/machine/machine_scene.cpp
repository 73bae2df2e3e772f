#include "tests/scenarios/machine/machine_scene.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <deque>
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
#include "tests/scenarios/machine/sound_handoff.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace scenarios {
namespace {

using namespace std::chrono_literals;
using emulator_models::MachineToolFailure;
using emulator_models::MachineToolPlant;
using emulator_models::soft_plc::IlProgram;
using protocol::PaperOptions;

constexpr auto scan_period = 10ms;
constexpr unsigned programs_count = 4;
constexpr unsigned blocks_in_program = 8;
constexpr unsigned hands_steps = 60;
constexpr std::uint64_t points_max = 20'000'000;
/// Of a process that was killed.
constexpr auto restart_after = 300ms;
/// Of a kernel that has to reckon with the loss of a request: longer than a PLC that works ever needs for an answer.
constexpr auto patience = 2s;

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
/// @param programs_left  what a kernel that is killed has not begun, the next one does
void run_kernel(ltsim::World& world, const PaperOptions& paper, FunctionMonitor& functions,
                SoundHandoff& handoff, const ShiftSetup& setup, unsigned& programs_left) {
  protocol::SharedMemoryPortManager ports{paper, &handoff};
  const auto port = ports.port("handoff");
  if (!port) return;
  kernel_mocks::FxDriverOptions line;
  if (setup.faults.need_time_outs()) line.answer_timeout = patience;
  kernel_mocks::FxDriver driver{**port, line};
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
  while (programs_left > 0) {
    --programs_left;
    kernel_mocks::PartProgramRunner runner{
        logic_task, {.panel = &panel, .operator_ = operator_is_busy ? &buttons : nullptr}};
    functions.program_begins();
    const kernel_mocks::RunResult result = runner.run(drawn_program(world));
    world.require(result.outcome == kernel_mocks::RunOutcome::ended || !result.message.empty(),
                  "a part program did not end, and nobody says why");
    std::this_thread::sleep_for(1s);
    (void)logic_task.set_plc_running(true);
  }
}

/// The emulator's process: what each life of it has made. A life that was killed is not unwound; it is kept until the
/// world has ended.
class EmulatorLives {
 public:
  EmulatorLives(ltsim::World& world, const IlProgram& program, const PaperOptions& paper,
                const ShiftSetup& setup, SoundHandoff& handoff, FunctionMonitor& functions)
      : world_{world},
        program_{program},
        paper_{paper},
        service_{setup.service},
        may_lose_posts_{setup.faults.lost_posts > 0},
        handoff_{handoff},
        process_{world.process("emulator")},
        plant_{world, functions, scan_period} {
    plant_.judge_only(setup.only_rule);
    begin_life();
  }

  void start() {
    process_.start("port", [this] {
      Life& life = current();
      if (life.slave.open()) life.handler.run();
    });
    process_.start("scan", [this] {
      Life& life = current();
      life.machine.scan();
      // The post that ends the port's task may be lost as any other, and nothing would end it then.
      if (may_lose_posts_) world_.finish();
      life.handler.request_stop();
    });
  }

  void stop() {
    is_over_ = true;
    lives_.back().machine.request_stop();
  }
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }
  /// The machine as it is now.
  [[nodiscard]] MachineToolPlant& plant() {
    if (!process_.is_running()) plant_.pass_without_plc();
    return plant_.plant();
  }

 private:
  struct Life {
    Life(EmulatorLives& all, emulator_models::SteadyTime now)
        : machine{all.plant_, all.program_, all.service_, now},
          slave{"handoff", all.paper_, &all.handoff_},
          handler{slave, machine.port()} {}
    WatchedMachine machine;
    protocol::SlaveSharedMemoryWrapper slave;
    emulator_models::EmulatorHandler handler;
  };

  void begin_life() {
    lives_.emplace_back(*this, emulator_models::SteadyTime{world_.now()});
    incarnation_ = process_.incarnation();
  }

  /// For the tasks of the process. Whichever comes first after a restart makes what both need, in one step.
  Life& current() {
    if (incarnation_ == process_.incarnation()) return lives_.back();
    const ltsim::GhostScope in_one_step;
    handoff_.slave_died();
    plant_.pass_without_plc();
    Life& dead = lives_.back();
    begin_life();
    lives_.back().machine.keep_latched(dead.machine);
    if (is_over_) lives_.back().machine.request_stop();
    return lives_.back();
  }

  ltsim::World& world_;
  const IlProgram& program_;
  const PaperOptions& paper_;
  PortService service_;
  bool may_lose_posts_;
  SoundHandoff& handoff_;
  ltsim::Process& process_;
  WatchedPlant plant_;
  std::deque<Life> lives_;
  unsigned incarnation_ = 0;  ///< of the last of them; one that was killed at once has made nothing
  bool is_over_ = false;
};

void grant(ltsim::World& world, const ShiftFaults& faults) {
  using enum ltsim::FaultKind;
  ltsim::Process& kernel = world.process("kernel");
  ltsim::Process& emulator = world.process("emulator");
  if (faults.kernel_kills > 0)
    kernel.may_crash({.times = faults.kernel_kills, .restart_after = restart_after});
  if (faults.plc_kills > 0) emulator.may_crash({.times = faults.plc_kills, .restart_after = restart_after});
  if (faults.stalls > 0) {
    kernel.may_stall(faults.stalls);
    emulator.may_stall(faults.stalls);
  }
  const auto grant_some = [&](ltsim::FaultKind kind, unsigned times) {
    if (times > 0) world.grant(kind, times);
  };
  grant_some(interrupt, faults.interrupts);
  grant_some(clock_step, faults.clock_steps);
  grant_some(lost_post, faults.lost_posts);
  grant_some(doubled_post, faults.doubled_posts);
}

/// What people and wear do to the machine.
void lay_hands_on(ltsim::World& world, EmulatorLives& emulator) {
  if (world.choose("hands-busy", 2) == 0) return;
  std::optional<MachineToolFailure> failure;
  bool button = false;
  bool pulled = false;
  bool pressed = false;
  for (unsigned i = 0; i < hands_steps && !emulator.is_over(); ++i) {
    std::this_thread::sleep_for(700ms);
    MachineToolPlant& plant = emulator.plant();
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

void run_shift(ltsim::World& world, const IlProgram& program, const ShiftSetup& setup) {
  PaperOptions paper;
  if (!setup.faults.need_time_outs()) paper.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  name_regions(world, "handoff", paper);
  world.set_points_max(points_max);
  FunctionMonitor functions{world};
  SoundHandoff handoff{functions};
  unsigned programs_left = programs_count;

  ltsim::Process& kernel = world.process("kernel");
  EmulatorLives emulator{world, program, paper, setup, handoff, functions};
  kernel.start("main", [&] {
    run_kernel(world, paper, functions, handoff, setup, programs_left);
    emulator.stop();
  });
  emulator.start();
  world.process("shop").start("hands", [&] { lay_hands_on(world, emulator); });
  grant(world, setup.faults);
  world.run();
}

}  // namespace scenarios
