// The random walk: at each scheduling point every task that can run is equally likely to run next.
//
// How often time passes although somebody could run differs between executions by three orders of magnitude:
// a short handoff needs one slow moment in some tens of steps, a part program of ten thousand steps would
// otherwise do nothing but time out. A slow moment lasts until the next timer, or one of 1 us, 2 us, 4 us ...
// 1 s, so that each order of magnitude is as likely as the others; every second one holds up the task at hand
// only.
#pragma once

#include "sim_clock/explore/random_generator.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class RandomStrategy final : public Strategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "random"; }
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;

 private:
  RandomGenerator generator_{0};
  unsigned slow_moment_bits_ = 1;  // a slow moment has the probability 2^-bits
  unsigned fault_bits_ = 1;        // and a fault, wherever one is possible
};

}  // namespace ltsim
