// Programs in instruction list as the cycles of a soft PLC, in simulated time, on one thread and with one for each.
#include "emulator_models/soft_plc/il_cycle.hpp"

#include <gtest/gtest.h>

#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/plc_threads.hpp"
#include "tests/emulator_models/soft_plc/plc_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

/// What a step takes.
constexpr nanoseconds step_time = 20us;

PlcCycleSetup cycle_of(std::string name, nanoseconds period, Section sends, const char* source) {
  const auto program = compile(source);
  EXPECT_TRUE(program) << to_string(program.error());
  return {.name = std::move(name),
          .config = {.scan = {.period = period}, .priority = 0},
          .sends = sends,
          .body = std::make_unique<IlCycle>(*program)};
}

class IlCycles : public testing::TestWithParam<PlcThreading> {
 protected:
  void make(PlcCycleSetup a, PlcCycleSetup b) {
    std::vector<PlcCycleSetup> cycles;
    cycles.push_back(std::move(a));
    cycles.push_back(std::move(b));
    plc_ = SoftPlc::make(setup_of(std::move(cycles)), 0ns).value();
    ASSERT_TRUE(plc_->order_run(StartKind::cold));
  }

  /// One step of the PLC, or of each cycle; time passes. Nobody calls supervise(): the cycles have to notice themselves.
  void step() {
    nanoseconds due = nanoseconds::max();
    if (GetParam() == PlcThreading::one) {
      due = plc_->advance(now_);
    } else {
      for (std::size_t i = 0; i < plc_->cycles_count(); ++i)
        due = std::min(due, plc_->advance_cycle(i, now_));
    }
    now_ = due > now_ ? due : now_ + step_time;
  }

  /// @return whether the lamp was lit on the way; then the time stands right after it
  bool run_until_lamp_or(nanoseconds end) {
    while (now_ < end && !plc_->alarm_lamp()) step();
    return plc_->alarm_lamp();
  }

  std::unique_ptr<SoftPlc> plc_;
  nanoseconds now_{0};
};

constexpr const char* counts_and_shows_the_answer =
    "PROGRAM fast\nVAR count AT %MW0 : INT; answer AT %MW1 : INT; shown AT %QW0 : INT; END_VAR\n"
    "LD count\nADD 1\nST count\nLD answer\nST shown\nEND_PROGRAM\n";
constexpr const char* doubles =
    "PROGRAM slow\nVAR count AT %MW0 : INT; answer AT %MW1 : INT; END_VAR\n"
    "LD count\nMUL 2\nST answer\nEND_PROGRAM\n";

TEST_P(IlCycles, exchange_variables_and_drive_outputs) {
  make(cycle_of("fast", 1ms, {0, 2}, counts_and_shows_the_answer), cycle_of("slow", 10ms, {2, 2}, doubles));
  EXPECT_FALSE(run_until_lamp_or(19'500us));
  // The slow one ran at 0 ms and at 10 ms, beside the first and the eleventh scan of the fast one.
  const std::uint64_t shown = word(plc_->gate().frame().outputs) & 0xFFFF;
  EXPECT_TRUE(shown == 20 || shown == 22) << shown;
  EXPECT_EQ(plc_->status(0).scan_times.scans_count, 20U);
  EXPECT_EQ(plc_->status(1).scan_times.scans_count, 2U);
}

// I20: by time, and not by the number of instructions.
TEST_P(IlCycles, an_endless_loop_is_stopped_by_the_watchdog_no_later_than_its_limit_and_one_slice) {
  make(cycle_of("good", 10ms, {0, 2}, counts_and_shows_the_answer),
       cycle_of("loops", 20ms, {},
                "PROGRAM loops\nVAR a AT %QX8.0 : BOOL; END_VAR\nLD TRUE\nST a\nagain:\nJMP again\n"
                "END_PROGRAM\n"));
  ASSERT_TRUE(run_until_lamp_or(1s));
  EXPECT_GT(now_, 150ms);
  EXPECT_LE(now_, 150ms + 4 * step_time)
      << "begun at most two steps after 0; one slice; the step that lit the lamp";
  EXPECT_EQ(plc_->gate().frame().outputs, OutputGate::Outputs{});
  for (int i = 0; i < 4; ++i) step();
  EXPECT_EQ(plc_->status(1).fault.value().code, FaultCode::watchdog);
  EXPECT_EQ(plc_->status(1).fault.value().action, ScanAction::execute);
  EXPECT_EQ(plc_->status(0).fault.value().code, FaultCode::other_cycle);
}

TEST_P(IlCycles, after_a_loop_that_was_cut_off_a_warm_start_begins_at_the_first_instruction) {
  make(cycle_of("idle", 10ms, {}, "PROGRAM idle\nLD TRUE\nEND_PROGRAM\n"),
       cycle_of("loops", 10ms, {},
                "PROGRAM loops\nVAR\nscans AT %MW0 : INT;\nEND_VAR\n"
                "LD scans\nADD 1\nST scans\nagain:\nLD scans\nEQ 3\nJMPC again\nEND_PROGRAM\n"));
  ASSERT_TRUE(run_until_lamp_or(1s));
  while (!plc_->order_reset() || !plc_->order_run(StartKind::warm)) step();
  while (plc_->alarm_lamp()) step();
  EXPECT_FALSE(run_until_lamp_or(now_ + 300ms)) << "the first instruction has counted on, to 4";
}

// The time of the scan is one in all its slices.
TEST_P(IlCycles, a_scan_of_several_slices_ends_and_counts_once) {
  make(cycle_of("idle", 10ms, {}, "PROGRAM idle\nLD TRUE\nEND_PROGRAM\n"),
       cycle_of("long", 10ms, {},
                "PROGRAM long\nVAR i : DINT; scans AT %QW4 : INT; END_VAR\n"
                "LD 0\nST i\nmore:\nLD i\nADD 1\nST i\nLT 2000\nJMPC more\nLD scans\nADD 1\nST scans\n"
                "END_PROGRAM\n"));
  EXPECT_FALSE(run_until_lamp_or(35ms));
  EXPECT_EQ(word(plc_->gate().frame().outputs, 8), 4U);
  EXPECT_GT(plc_->status(1).scan_times.shortest, 5 * step_time) << "10000 instructions are some slices";
}

TEST_P(IlCycles, a_division_by_zero_stops_the_PLC_with_the_place) {
  const auto program =
      compile("PROGRAM divides\nVAR n AT %MW0 : INT; END_VAR\nLD 1\nDIV n\nST n\nEND_PROGRAM\n");
  ASSERT_TRUE(program) << to_string(program.error());
  auto body = std::make_unique<IlCycle>(*program);
  const IlCycle& watched = *body;
  PlcCycleSetup divides{.name = "divides", .config = {}, .sends = {}, .body = std::move(body)};
  make(cycle_of("idle", 10ms, {}, "PROGRAM idle\nLD TRUE\nEND_PROGRAM\n"), std::move(divides));
  ASSERT_TRUE(run_until_lamp_or(1s));
  EXPECT_EQ(to_string(watched.run_time_fault().value()), "4:1: division by zero");
  EXPECT_EQ(plc_->status(1).fault.value().code, FaultCode::program_failed);
}

INSTANTIATE_TEST_SUITE_P(Threadings, IlCycles, testing::Values(PlcThreading::one, PlcThreading::per_cycle));

}  // namespace
}  // namespace emulator_models::soft_plc
