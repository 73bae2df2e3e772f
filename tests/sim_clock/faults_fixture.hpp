// For tests of faults: executions whose faults are written down as the lines of a schedule.
#pragma once

#include <string>
#include <vector>

#include "sim_clock/explore/explorer.hpp"
#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {

inline sem_t* open_semaphore() { return sem_open("/s", O_CREAT, 0600, 0U); }

inline SimTime to_time(const timespec& time) {
  return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
}

/// The test fails if it is asked for a fault.
class NeverStrikes final : public DefaultStrategy {
 public:
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t /*variants*/) noexcept override {
    ADD_FAILURE() << to_string(kind) << " was asked for";
    return 0;
  }
};

class FaultsTest : public CallsTest {
 protected:
  /// Runs the scenario with these lines of a schedule, and otherwise by default. Each line must be carried out.
  static Outcome run_with(const std::vector<std::string>& lines, void (*body)(World&)) {
    const Schedule schedule = schedule_of(lines);
    const ReplayReport report = replay(schedule, body);
    EXPECT_FALSE(report.divergence) << report.divergence->deviation->anchor << ": "
                                    << report.divergence->reason;
    return report.outcome;
  }

  static Schedule schedule_of(const std::vector<std::string>& lines) {
    std::string text = "ltsim schedule 1\nscenario test/faults\n";
    for (const std::string& line : lines) text += line + "\n";
    const auto schedule = parse_schedule(text);
    EXPECT_TRUE(schedule) << schedule.error().line << ": " << schedule.error().reason;
    return schedule ? *schedule : Schedule{};
  }

  static ReplayReport replay(const Schedule& schedule, void (*body)(World&)) {
    return Explorer{world()}.replay(Scenario{"test/faults", "", body}, schedule, nullptr);
  }

  /// Runs a seed under the random strategy. Run again it must be the same, and so it must when it has been
  /// written down, printed, read and replayed.
  static Failure record_and_replay(std::uint64_t seed, void (*body)(World&)) {
    const Scenario scenario{"test/faults", "", body};
    Explorer explorer{world()};
    RandomStrategy strategy;
    const SignalGuard signals;
    const std::uint64_t hash = explorer.execute(scenario, strategy, seed, nullptr);
    Failure recorded = explorer.record(scenario, strategy, seed);
    EXPECT_EQ(recorded.trace_hash, hash) << seed;
    const auto schedule = parse_schedule(to_string(recorded.schedule));
    EXPECT_TRUE(schedule) << seed << ": " << schedule.error().reason;
    if (!schedule) return recorded;
    EXPECT_EQ(schedule->deviations, recorded.schedule.deviations) << seed;
    const ReplayReport replayed = replay(*schedule, body);
    EXPECT_FALSE(replayed.divergence)
        << seed << ": " << replayed.divergence->deviation->anchor << ": " << replayed.divergence->reason;
    EXPECT_EQ(replayed.trace_hash, hash) << seed;
    EXPECT_EQ(replayed.outcome, recorded.outcome) << seed;
    return recorded;
  }
};

}  // namespace ltsim
