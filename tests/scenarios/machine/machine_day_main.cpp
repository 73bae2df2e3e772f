// machine-day: the machine tool for a simulated day, scanned each millisecond, one part program after the other, a
// random failure each hour; every interlock looked at after every scan, the history in an archive.
//
// One execution of the simulated world in its default order: nobody is held up. Other orders are the matter of the
// scenarios machine/*.
//
// Exit codes: 0 no violation; 1 a violation, or another failure of the execution; 2 bad usage, or no archive.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <thread>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "emulator_models/archive/archive_drain.hpp"
#include "emulator_models/fx_recorder.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "kernel_mocks/nc_parser.hpp"
#include "kernel_mocks/part_program_runner.hpp"
#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/strategy.hpp"
#include "tests/scenarios/compiled_program.hpp"
#include "tests/scenarios/machine/local_port.hpp"
#include "tests/scenarios/machine/watched_machine.hpp"

namespace {

using namespace std::chrono_literals;
using emulator_models::MachineToolFailure;
using kernel_mocks::RunOutcome;
using protocol::fx::Device;
using protocol::fx::DeviceKind;

constexpr auto scan_period = 1ms;

/// One workpiece. A part program has so many that it lasts an hour.
constexpr unsigned workpieces_in_program = 100;
constexpr const char* workpiece = R"(N5 M10
N10 T3 M6
N20 S1500 M3
N30 M8
N40 G1 X40 Y10 F1200
N50 G2 X60 Y30 I20
N60 M9
N70 M5
N80 T8 M6
N90 S900 M13
N100 G1 X10 F600
N110 G4 P0.5
N120 M19
N130 M9
N140 T0 M6
N150 M11
N160 M10
N170 G0 X0 Y0
)";

/// The default at each choice: nobody is held up, no time passes while somebody can run.
class DefaultOrder final : public ltsim::Strategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "default-order"; }
  void begin_execution(std::uint64_t /*seed*/) noexcept override {}
  [[nodiscard]] std::size_t choose_task(const ltsim::TaskChoice& /*choice*/) noexcept override { return 0; }
  [[nodiscard]] ltsim::SlowMoment slow_moment(const ltsim::SlowMomentChoice& /*choice*/) noexcept override {
    return {};
  }
  [[nodiscard]] std::size_t strike(ltsim::FaultKind /*kind*/, std::size_t /*count*/) noexcept override {
    return 0;
  }
  [[nodiscard]] std::size_t answer(std::size_t /*count*/) noexcept override { return 0; }
  [[nodiscard]] std::size_t choose_age(const ltsim::AgeChoice& /*choice*/) noexcept override { return 0; }
};

struct Arguments {
  double hours = 24;
  std::uint64_t seed = 1;
  std::string archive;
  std::int64_t rows_max = 200'000;
};

struct Shift {
  std::atomic<bool> over{false};
  std::atomic<bool> broken{false};  ///< a failure is there
  std::uint64_t workpieces = 0;
  std::map<std::string, unsigned> endings;  ///< why part programs were cut short
  std::uint64_t failures = 0;
};

kernel_mocks::Program part_program() {
  std::string text = "%\n";
  for (unsigned i = 0; i < workpieces_in_program; ++i) text += workpiece;
  return kernel_mocks::parse_program(text + "M30\n%").value();
}

/// Counts the workpieces.
class WorkpieceCounter final : public kernel_mocks::PartProgramObserver {
 public:
  void moved(const kernel_mocks::Block& block, kernel_mocks::MotionKind /*kind*/,
             std::chrono::nanoseconds /*duration*/, bool reached) noexcept override {
    if (reached && block.number == last_motion) ++count_;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  static constexpr std::uint32_t last_motion = 170;
  std::uint64_t count_ = 0;
};

std::string reason_of(const kernel_mocks::RunResult& result) {
  if (!result.failure) return result.message;
  if (result.failure->fault == kernel_mocks::LogicFault::alarm)
    return fmt::format("PLC alarm {}", result.failure->alarm_number);
  kernel_mocks::LogicFailure failure = *result.failure;
  failure.after = 0ns;
  return to_string(failure);
}

/// One part program after the other; after one that fails the operator has the machine repaired, puts things right
/// and begins anew.
void run_kernel(scenarios::WatchedMachine& machine, scenarios::FunctionMonitor& functions, Shift& shift) {
  const kernel_mocks::Program program = part_program();
  scenarios::LocalPort port{machine.port()};
  kernel_mocks::FxDriver driver{port, {}};
  kernel_mocks::LogicTask logic_task{
      driver, {.poll_interval = 50ms, .fin_timeout = 30s, .ready_timeout = 6s}, &functions, &shift.over};
  WorkpieceCounter workpieces;
  kernel_mocks::PartProgramRunner runner{logic_task, {}, &workpieces};
  while (!shift.over.load()) {
    functions.program_begins();
    const kernel_mocks::RunResult result = runner.run(program);
    shift.workpieces = workpieces.count();
    if (result.outcome == RunOutcome::ended) continue;
    if (!shift.over.load()) ++shift.endings[reason_of(result)];
    do std::this_thread::sleep_for(20s);
    while (shift.broken.load() && !shift.over.load());
    machine.put_tool_table_right();
    (void)logic_task.set_plc_running(true);
  }
}

/// One failure in each hour, at a random moment, for half a minute to five.
void break_down(emulator_models::MachineToolPlant& plant, std::uint64_t seed, Shift& shift) {
  std::mt19937_64 random{seed};
  const auto sleep = [&](std::chrono::seconds duration) {
    for (; duration > 0s && !shift.over.load(); duration -= 1s) std::this_thread::sleep_for(1s);
  };
  while (!shift.over.load()) {
    const std::chrono::seconds begin{random() % 3000};
    const std::chrono::seconds length{30 + random() % 270};
    sleep(begin);
    if (shift.over.load()) return;
    const auto failure =
        static_cast<MachineToolFailure>(random() % emulator_models::machine_tool_failures_count);
    plant.set_failure(failure, true);
    shift.broken.store(true);
    ++shift.failures;
    sleep(length);
    plant.set_failure(failure, false);
    shift.broken.store(false);
    sleep(3600s - begin - length);
  }
}

int run(const Arguments& arguments) {
  using namespace emulator_models;
  const protocol::fx::Model model = protocol::fx::Model::fx3u;
  auto database =
      archive::ArchiveDatabase::open({.file = arguments.archive,
                                      .rows_max = arguments.rows_max,
                                      .power_up_wall_clock = ltsim::World::wall_clock_epoch,
                                      .signal_names = {"spindle clockwise", "flood pump", "alarm"}});
  if (!database) {
    fmt::print(stderr, "machine-day: {}\n", database.error().message);
    return 2;
  }
  const ltsim::SignalGuard signals;
  ltsim::World world;
  DefaultOrder order;
  world.reset(order, nullptr);
  world.set_points_max(std::uint64_t{1} << 40U);

  const soft_plc::IlProgram program = scenarios::compiled_for_fx3u(machine_tool_program());
  scenarios::FunctionMonitor functions{world};
  scenarios::WatchedPlant plant{world, functions, scan_period};
  scenarios::WatchedMachine machine{plant, program};
  FxRecorder recorder{
      {.signals = {{DeviceKind::y, 0}, {DeviceKind::y, 3}, {DeviceKind::m, 121}}}, model, SteadyTime{}};
  machine.observe_with(&recorder);
  archive::ArchiveDrain drain{std::move(*database), {&recorder.ring()}, {}};
  const auto length =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::duration<double>{arguments.hours * 3600});
  Shift shift;
  const auto begin = std::chrono::steady_clock::now();

  world.process("kernel").start("main", [&] { run_kernel(machine, functions, shift); });
  world.process("emulator").start("scan", [&] { machine.scan(); });
  world.process("shop").start("failures", [&] { break_down(plant.plant(), arguments.seed, shift); });
  world.process("shop").start("archive", [&] {
    for (auto passed = 0s; passed < length; passed += 1s) {
      std::this_thread::sleep_for(1s);
      const ltsim::GhostScope outside;
      drain.drain();
    }
    shift.over.store(true);
    // The kernel resets the machine first.
    std::this_thread::sleep_for(60s);
    machine.request_stop();
  });
  world.run();
  const auto outcome = world.scheduler().outcome();
  recorder.finish(SteadyTime{world.now()});
  world.end_execution();
  drain.finish();

  const auto counts = drain.counts();
  const std::chrono::duration<double> real = std::chrono::steady_clock::now() - begin;
  fmt::print("{:.2f} h simulated in {:.1f} s ({:.0f} scans a second, {} scheduling points)\n",
             arguments.hours, real.count(), static_cast<double>(length / scan_period) / real.count(),
             world.scheduler().points());
  fmt::print("{} workpieces; {} failures of the machine; part programs cut short:\n", shift.workpieces,
             shift.failures);
  for (const auto& [reason, count] : shift.endings) fmt::print("  {:3} by {}\n", count, reason);
  fmt::print("archive {}: {} rows written, {} lost; the newest {} are kept\n", arguments.archive,
             counts.stored_count, counts.lost_count, arguments.rows_max);
  if (!outcome.passed()) {
    fmt::print("{}: {} at {}\n", to_string(outcome.kind), outcome.message,
               std::chrono::duration_cast<std::chrono::milliseconds>(world.now()));
    return 1;
  }
  fmt::print("no rule was broken\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{
      "The machine tool for a simulated day: part programs, a failure each hour, every interlock watched."};
  app.add_option("--archive", arguments.archive, "SQLite file of the history; its folder must be there")
      ->required();
  app.add_option("--hours", arguments.hours, "simulated time")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "all failures follow from it")->capture_default_str();
  app.add_option("--rows", arguments.rows_max, "rows that the archive keeps")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100'000'000}))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return run(arguments);
}
