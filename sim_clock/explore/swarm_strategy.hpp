// The default: a portfolio that learns. Each execution is made by one of the other strategies, drawn at random;
// what yields something new is drawn more often.
//
// No strategy wins everywhere: what the partial order sampler finds at once, a random walk with a silence never
// does, and the other way round. Three executions of four follow a fixed cycle, so that none is ever given up; the
// fourth is drawn in proportion to what each strategy has yielded of late: new abstract states, new reads-from
// pairs, and above all failures of a new kind. Shares of the cycle: measured over the known races, see
// tests/bench/strategies_bench.cpp. Each strategy draws its own parameters, and which faults are on at all, for
// each execution.
#pragma once

#include <array>

#include "sim_clock/explore/pct_strategy.hpp"
#include "sim_clock/explore/pos_strategy.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "sim_clock/explore/stall_strategy.hpp"
#include "sim_clock/explore/surw_strategy.hpp"

namespace ltsim {

class SwarmStrategy final : public Strategy {
 public:
  SwarmStrategy() noexcept {
    for (SamplingStrategy* const member : members_) member->share(experience_);
  }

  [[nodiscard]] std::string_view name() const noexcept override { return "swarm"; }
  void begin_execution(std::uint64_t seed) noexcept override;
  void learn(const ExecutionSummary& summary) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override {
    return current_->choose_task(choice);
  }
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override {
    return current_->slow_moment(choice);
  }
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override {
    return current_->strike(kind, variants_count);
  }
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override { return current_->answer(count); }
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override {
    return current_->choose_age(choice);
  }
  [[nodiscard]] bool passes_uncontended() const noexcept override { return current_->passes_uncontended(); }
  [[nodiscard]] bool follows_steps() const noexcept override { return current_->follows_steps(); }
  void performs(TaskId task, const Operation& operation) noexcept override {
    current_->performs(task, operation);
  }

 private:
  enum Member : std::size_t { random, pct, pos, surw, stall };
  static constexpr std::size_t members_count = 5;

  Experience experience_;
  RandomStrategy random_;
  PctStrategy pct_;
  PosStrategy pos_;
  SurwStrategy surw_;
  StallStrategy stall_;
  std::array<SamplingStrategy*, members_count> members_{&random_, &pct_, &pos_, &surw_, &stall_};
  static constexpr std::array<Member, 24> cycle{pos,  surw, pct,  pos, surw, pos,  surw,   pos,
                                                surw, pos,  surw, pct, pos,  surw, stall,  pos,
                                                surw, pos,  surw, pct, pos,  surw, random, pos};
  std::uint64_t executions_ = 0;                       // that count
  std::uint64_t cycle_executions_ = 0;                 // of these, by the cycle
  std::array<std::uint32_t, members_count> yields_{};  // of late
  bool by_cycle_ = true;                               // this execution
  std::size_t drawn_ = 0;
  SamplingStrategy* current_ = &random_;
};

}  // namespace ltsim
