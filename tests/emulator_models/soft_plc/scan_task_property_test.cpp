// The invariants of one cycle, against orders, faults and durations drawn at random, with fixed seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "emulator_models/soft_plc/scan_task.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr nanoseconds watchdog_limit = 9ms;

constexpr ScanAction order_within_a_scan[] = {ScanAction::system_analysis, ScanAction::clear_fault,
                                              ScanAction::initialise,      ScanAction::write_safe_outputs,
                                              ScanAction::read_inputs,     ScanAction::read_from_cycles,
                                              ScanAction::execute,         ScanAction::write_to_cycles,
                                              ScanAction::write_outputs,   ScanAction::refresh_output_image,
                                              ScanAction::enter_fault,     ScanAction::wait};

auto place(ScanAction action) { return std::ranges::find(order_within_a_scan, action) - order_within_a_scan; }

bool belongs_to_run(ScanAction action) {
  return place(action) >= place(ScanAction::read_from_cycles) &&
         place(action) <= place(ScanAction::write_outputs);
}

/// Sees the orders and the steps, and knows what they must be to each other.
class Witness {
 public:
  void stop_ordered() {
    ++stops_;
    run_is_ordered_ = false;
  }
  void halted() { run_is_ordered_ = false; }
  void run_accepted() { run_is_ordered_ = true; }

  void check(const ScanStep& step, nanoseconds now, const ScanTask& task) {
    const bool in_scan = before_ != ScanAction::wait && before_ != ScanAction::enter_fault;
    if (before_ == ScanAction::system_analysis || before_ == ScanAction::clear_fault) {
      stops_seen_ = stops_;
      runs_ = run_is_ordered_;
    }
    if (in_scan && runs_before_this_step_ && now - scan_start_ > watchdog_limit) {
      EXPECT_EQ(step.action, ScanAction::enter_fault);  // I3
    }
    if (in_scan) {
      EXPECT_GE(place(step.action), place(before_));
    }
    if (before_ == ScanAction::enter_fault) {
      EXPECT_EQ(step.action, ScanAction::wait);  // I5
    }
    switch (step.action) {
      case ScanAction::system_analysis:
        scan_start_ = now;
        initialised_now_ = false;
        break;
      case ScanAction::initialise:
        stops_initialised_ = stops_seen_;
        initialised_now_ = true;
        break;
      case ScanAction::enter_fault:
        stop_ordered();
        runs_ = false;
        break;
      default:
        break;
    }
    if (belongs_to_run(step.action)) {
      EXPECT_TRUE(runs_);                            // I1
      EXPECT_EQ(stops_initialised_, stops_seen_);    // I2
      EXPECT_EQ(step.first_scan, initialised_now_);  // I2
      EXPECT_FALSE(task.fault());                    // I4
    }
    if (step.action == ScanAction::refresh_output_image) {
      EXPECT_FALSE(runs_);  // I1
    }
    before_ = step.action;
    runs_before_this_step_ = task.mode() == RunMode::run;
  }

 private:
  ScanAction before_ = ScanAction::wait;
  nanoseconds scan_start_{0};
  int stops_ = 1;
  int stops_seen_ = 0;
  int stops_initialised_ = 0;
  bool run_is_ordered_ = false;
  bool runs_ = false;
  bool runs_before_this_step_ = false;
  bool initialised_now_ = false;
};

TEST(ScanTaskProperty, no_order_and_no_fault_at_any_moment_breaks_a_scan) {
  for (std::uint64_t seed = 1; seed <= 60 && !testing::Test::HasFailure(); ++seed) {
    std::mt19937_64 random{seed};
    const auto one_in = [&](std::uint64_t n) { return random() % n == 0; };
    ScanTask task = ScanTask::make({.period = 5ms,
                                    .overrun = static_cast<OverrunRule>(seed % 3),
                                    .watchdog_limit = watchdog_limit,
                                    .exchanges_with_cycles = seed % 2 == 0},
                                   nanoseconds{0})
                        .value();
    Witness witness;
    nanoseconds now{0};
    Progress last = Progress::finished;
    for (int i = 0; i < 2000 && !testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", step " << i);
      const ScanStep step = task.next(now, last);
      witness.check(step, now, task);
      last = Progress::finished;
      if (step.action == ScanAction::wait) {
        now = std::max(now, step.until) + (one_in(10) ? 7ms : 0ms);
      } else {
        now += std::chrono::microseconds{random() % (one_in(30) ? 12'000 : 400)};
        if (step.action == ScanAction::execute && one_in(2)) {
          last = one_in(25) ? Progress::failed : Progress::unfinished;
        }
      }
      if (one_in(15) && task.order_run(one_in(2) ? StartKind::cold : StartKind::warm)) witness.run_accepted();
      if (one_in(40)) {
        task.order_stop();
        witness.stop_ordered();
      }
      if (one_in(8)) task.order_reset();
      if (one_in(200)) {
        task.halt(FaultCode::other_cycle);
        witness.halted();
      }
    }
    EXPECT_GT(task.period().overruns_count(), 0U);
  }
}

}  // namespace
}  // namespace emulator_models::soft_plc
