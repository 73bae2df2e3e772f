// For tests of the world itself: one world, run under a strategy of the test's choice.
#pragma once

#include <functional>
#include <ostream>

#include <gtest/gtest.h>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/explore/strategy.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

/// The default everywhere: what a schedule without lines means.
class DefaultStrategy : public Strategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "default"; }
  void begin_execution(std::uint64_t /*seed*/) noexcept override {}
  [[nodiscard]] std::size_t choose_task(const TaskChoice& /*choice*/) noexcept override { return 0; }
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& /*choice*/) noexcept override { return {}; }
  [[nodiscard]] std::size_t strike(FaultKind /*kind*/, std::size_t /*variants*/) noexcept override {
    return 0;
  }
  [[nodiscard]] std::size_t answer(std::size_t /*count*/) noexcept override { return 0; }
  [[nodiscard]] std::size_t choose_age(const AgeChoice& /*choice*/) noexcept override { return 0; }
};

inline void PrintTo(const Outcome& outcome, std::ostream* out) {
  *out << to_string(outcome.kind) << ": " << outcome.message;
}

class WorldTest : public testing::Test {
 protected:
  using Setup = std::function<void(World&)>;

  /// One execution that makes no choice. `setup` makes the tasks; they run when it has returned.
  static Outcome run(const Setup& setup) {
    DefaultStrategy strategy;
    return run_under(strategy, 0, setup);
  }

  /// Executions with the seeds 1 to `count`, until one fails.
  static Outcome run_randomly(unsigned count, const Setup& setup) {
    RandomStrategy strategy;
    Outcome outcome;
    for (unsigned seed = 1; seed <= count && outcome.passed(); ++seed)
      outcome = run_under(strategy, seed, setup);
    return outcome;
  }

  static Outcome run_under(Strategy& strategy, std::uint64_t seed, const Setup& setup) {
    const SignalGuard signals;
    strategy.begin_execution(seed);
    world().reset(strategy, nullptr);
    setup(world());
    world().run();
    world().end_execution();
    return world().scheduler().outcome();
  }

  static World& world() {
    static World only;
    return only;
  }
};

}  // namespace ltsim
