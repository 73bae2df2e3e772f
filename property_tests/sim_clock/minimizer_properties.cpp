// What the minimizer makes of a failure fails in the same way, and would not without any one of its lines.

#include "property_tests/sim_clock/small_program.hpp"
#include "property_tests/support/property.hpp"
#include "sim_clock/explore/minimizer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/explore/same_failure.hpp"

namespace property_tests {
namespace {

using namespace ltsim;

PROPERTY(Minimizer, ends_with_the_same_failure_and_no_line_too_many, ()) {
  using enum Step::Kind;
  const SmallProgram program = *any_small_program({add, add, add, count, post, sleep, time_out, ask, wait});
  const Scenario scenario = scenario_of(program);
  RandomStrategy strategy;
  ExploreOptions explore;
  explore.executions_max = 60;
  const ExploreReport found = Explorer{world()}.explore(scenario, strategy, explore);
  RC_PRE(!found.failures.empty());
  const Schedule& recorded = found.failures.front().schedule;

  const MinimizeReport report = Minimizer{world(), scenario}.minimize(
      recorded, {.seconds_max = std::chrono::hours{1}, .executions_max = 5'000});
  RC_ASSERT(report.reproduced);
  RC_ASSERT(report.one_minimal);
  RC_ASSERT(report.schedule.deviations.size() <= recorded.deviations.size());
  const auto replay = [&](const Schedule& schedule) {
    return Explorer{world()}.replay(scenario, schedule, nullptr);
  };
  const ReplayReport replayed = replay(report.schedule);
  RC_ASSERT(!replayed.divergence);
  RC_ASSERT(same_failure(replayed.outcome, recorded));
  RC_ASSERT(replayed.trace_hash == report.trace_hash);
  for (std::size_t i = 0; i < report.schedule.deviations.size(); ++i) {
    Schedule without_one = report.schedule;
    without_one.deviations.erase(without_one.deviations.begin() + static_cast<std::ptrdiff_t>(i));
    RC_ASSERT(!same_failure(replay(without_one).outcome, recorded));
  }
}

}  // namespace
}  // namespace property_tests
