// The machine tool in the world: with its program as it is, and with each interlock rule taken out of it.
#include <chrono>
#include <limits>
#include <string>
#include <string_view>

#include "emulator_models/fx_plc_loop.hpp"
#include "emulator_models/plants/machine_tool_rules.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/compiled_program.hpp"
#include "tests/scenarios/machine/machine_scene.hpp"
#include "tests/scenarios/rule_mutants.hpp"

namespace {

using emulator_models::soft_plc::IlProgram;

const IlProgram& whole_program() {
  static const IlProgram program = scenarios::compiled_for_fx3u(emulator_models::machine_tool_program());
  return program;
}

}  // namespace

SCENARIO("machine/shift",
         "random part programs, an operator and failures on the machine tool; every interlock holds") {
  scenarios::run_shift(world, whole_program());
}

SCENARIO("machine/shift-kernel-kills",
         "the same shift; the kernel is killed at any time, and started again") {
  scenarios::run_shift(world, whole_program(), {.faults = {.kernel_kills = 2}});
}

SCENARIO("machine/shift-plc-kills",
         "the same shift; the PLC is killed at any time: its outputs drop, and it starts again") {
  scenarios::run_shift(world, whole_program(), {.faults = {.plc_kills = 2}});
}

SCENARIO("machine/shift-stalls",
         "the same shift; kernel and PLC get no processor for a while, calls are interrupted, the wall clock "
         "is set") {
  scenarios::run_shift(world, whole_program(), {.faults = {.stalls = 2, .interrupts = 3, .clock_steps = 2}});
}

SCENARIO("machine/shift-posts", "the same shift; posts of the handoff's semaphore are lost or doubled") {
  scenarios::run_shift(world, whole_program(), {.faults = {.lost_posts = 2, .doubled_posts = 2}});
}

SCENARIO("machine/fin-wait-removed",
         "the kernel raises the next strobe while FIN may still be that of the last one") {
  scenarios::run_shift(
      world, whole_program(),
      {.service = scenarios::PortService::between_scans, .fin_wait = scenarios::FinWait::none});
}

SCENARIO("machine/o23-short-strobe",
         "the kernel holds its strobes for four scans and takes each function for done") {
  scenarios::run_shift(
      world, whole_program(),
      {.service = scenarios::PortService::between_scans, .strobe_hold = scenarios::StrobeHold::fixed_time});
}

SCENARIO("machine/fin-wait-removed-corrected", "the next strobe rises only when FIN is low") {
  scenarios::run_shift(world, whole_program(), {.service = scenarios::PortService::between_scans});
}

SCENARIO("machine/endless-program",
         "a PLC program that never ends: the watchdog stops it, outputs off, lamp on") {
  using namespace emulator_models;
  static const soft_plc::IlProgram program = scenarios::compiled_for_fx3u(
      "PROGRAM endless\nVAR y AT Y0 : BOOL; hangs AT M0 : BOOL; scans AT D0 : INT; END_VAR\n"
      "LD TRUE\nST y\nLD scans\nADD 1\nST scans\nGT 3\nST hangs\n"
      "here:\nLD hangs\nJMPC here\nEND_PROGRAM\n");
  constexpr std::chrono::milliseconds limit{150};
  // A slice is worth its scheduling points: the simulated processor needs 100 ns for each.
  constexpr std::uint64_t slice_instructions = 16;
  constexpr std::uint64_t points_max = 20'000'000;
  world.set_points_max(points_max);
  bool was_on = false;
  FxPlcEmulator emulator{protocol::fx::Model::fx3u};
  FxPlc plc{emulator,
            program,
            [&](const Terminals& terminals, SteadyTime) { was_on = was_on || terminals.outputs.test(0); },
            nullptr,
            {.period = std::chrono::milliseconds{10},
             .watchdog_limit = limit,
             .slice_instructions = slice_instructions,
             .scan_instructions_max = std::numeric_limits<std::uint64_t>::max()},
            SteadyTime{}};
  FxPlcLoop* scanning = nullptr;
  FxPlcLoop loop{plc, [&](const FxPlc& /*told*/) { scanning->request_stop(); }};
  scanning = &loop;
  world.process("emulator").start("scan", [&] { loop.run(); });
  world.run();
  world.require(plc.fault() && plc.fault()->code == soft_plc::FaultCode::watchdog,
                "I20: the watchdog has not bitten");
  if (!plc.fault()) return;
  // It hangs in its fourth scan; a world that holds the PLC up can have it stopped before.
  const bool hung = plc.fault()->action == soft_plc::ScanAction::execute && plc.fault()->scan_number > 3;
  world.require(was_on || !hung, "the output was never on");
  world.require(!hung || plc.fault()->scan_time > limit, "I21: a scan within its limit was stopped");
  world.require(plc.terminals().outputs.none(), "I19: an output is on after the stop");
  world.require(plc.cpu_error_lamp(), "the lamp is off");
  // How late it is noticed is a matter of how long the PLC itself gets no processor: here nobody else wants it.
  world.note([&] { return "bitten after " + std::to_string(plc.fault()->scan_time.count()) + " ns"; });
}

namespace {

struct ShiftWithoutRule {
  static constexpr std::string_view group = "machine";
  /// One is the PLC's own, no line of the program.
  static constexpr std::size_t rules_count = emulator_models::machine_tool_rules_count - 1;
  static std::string_view source() { return emulator_models::machine_tool_program(); }
  static void run(ltsim::World& world, const IlProgram& program, const std::string& rule) {
    scenarios::run_shift(world, program, {.only_rule = rule});
  }
};

[[maybe_unused]] const std::size_t registered_count =
    scenarios::RuleMutants<ShiftWithoutRule>::register_all();

}  // namespace
