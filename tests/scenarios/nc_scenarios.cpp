// The whole kernel and the whole emulator: a part program drives the built-in machine over the published
// handoff.

#include <chrono>
#include <optional>
#include <thread>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "kernel_mocks/fx_driver.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/nc_parser.hpp"
#include "kernel_mocks/part_program_runner.hpp"
#include "protocol/shared_memory_port_manager.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/compiled_program.hpp"
#include "tests/scenarios/machine/watched_machine.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace {

using protocol::PaperOptions;

constexpr const char* part_program = R"(%
N10 M3 S1500
N20 M8
N30 G1 X10 F200
N40 T5 M6
N50 M5
N60 M9
N70 M30
%)";

/// Parsed once: the text never changes, and parsing has nothing to do with the exchange.
const kernel_mocks::Program& program() {
  static const kernel_mocks::Program parsed = kernel_mocks::parse_program(part_program).value();
  return parsed;
}

/// @return nothing if the kernel could not reach the PLC at all
std::optional<kernel_mocks::RunOutcome> run_kernel(const char* segment, const PaperOptions& options,
                                                   kernel_mocks::LogicTaskObserver& observer) {
  protocol::SharedMemoryPortManager ports{options};
  const auto port = ports.port(segment);
  if (!port) return std::nullopt;
  kernel_mocks::FxDriver driver{**port, {}};
  if (!driver.connect()) return std::nullopt;
  // The hydraulics need up to two seconds for their pressure.
  kernel_mocks::LogicTask logic_task{driver, {.ready_timeout = std::chrono::seconds{5}}, &observer};
  kernel_mocks::PartProgramRunner runner{logic_task, {}};
  return runner.run(program()).outcome;
}

void run_part_program(ltsim::World& world, const PaperOptions& options) {
  constexpr const char* segment = "handoff";
  scenarios::name_regions(world, segment, options);
  scenarios::FunctionMonitor monitor{world};
  static const auto plc_program = scenarios::compiled_for_fx3u(emulator_models::machine_tool_program());
  scenarios::WatchedPlant plant{world, monitor, std::chrono::milliseconds{10}};
  scenarios::WatchedMachine machine{plant, plc_program};
  protocol::SlaveSharedMemoryWrapper slave{segment, options};
  emulator_models::EmulatorHandler handler{slave, machine.port()};
  std::optional<kernel_mocks::RunOutcome> outcome;

  world.process("kernel").start("main", [&] {
    outcome = run_kernel(segment, options, monitor);
    handler.request_stop();
    machine.request_stop();
  });
  world.process("emulator").start("port", [&] {
    if (slave.open()) handler.run();
  });
  world.process("emulator").start("scan", [&] { machine.scan(); });
  world.run();
  // In a machine that is slow enough a wait times out and the kernel stops the program: that is its duty, not
  // a fault.
  if (outcome == kernel_mocks::RunOutcome::ended) monitor.check_at_end();
}

}  // namespace

SCENARIO("nc/part-program", "a part program on the whole kernel and emulator; the handoff never times out") {
  PaperOptions options;
  options.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  run_part_program(world, options);
}
