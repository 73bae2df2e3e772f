// What all randomised strategies have in common: a generator, and how they let time pass, let faults strike
// and answer questions. They differ in how they choose tasks.
//
// Time. In each execution it passes in one of these ways while somebody could run:
//   bursts   with the same probability, 2^-3 to 2^-13, at each point: the machine, or the one task at hand;
//   silence  one to three times, each before an operation drawn uniformly from those of the whole execution
//            that act on something in particular;
//   clock    the clock takes part like a task: it "runs" by going on to the next timer, when the strategy
//            chooses it (clock_goes_first()).
// A slow moment lasts for a time drawn log-uniformly from 1 us to 2 s, or for a multiple of the time to the next
// timer, or of the last such time known: an answer that is five time-outs late is one decision. Nobody who could run is held
// up for more than 16 s at a time: that is no slow machine any more.
//
// Faults. Of the kinds that are granted, each is on in every second execution, and then strikes at places
// drawn uniformly from its occasions.
#pragma once

#include <array>

#include "sim_clock/explore/occasions.hpp"
#include "sim_clock/explore/random_generator.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class SamplingStrategy : public Strategy {
 public:
  void begin_execution(std::uint64_t seed) noexcept final;
  void learn(const ExecutionSummary& summary) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept final;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept final;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept final;

 protected:
  enum class TimeMode : std::uint8_t { bursts, silence, clock };

  /// Draws what the kind of strategy needs for an execution. @return how time passes in it
  virtual TimeMode begin() noexcept = 0;
  /// In time mode `clock`, with a timer armed: whether time goes on to the next timer before anybody runs.
  [[nodiscard]] virtual bool clock_goes_first(const SlowMomentChoice& /*choice*/) noexcept { return false; }

  [[nodiscard]] RandomGenerator& generator() noexcept { return generator_; }

 private:
  [[nodiscard]] SlowMoment draw_slow_moment() noexcept;

  RandomGenerator generator_{0};
  TimeMode time_mode_ = TimeMode::bursts;
  SimTime period_{0};          // the last time to the next timer that was seen; 0: none yet
  SimTime period_learned_{0};  // the same at the end of the last execution that counts
  unsigned burst_bits_ = 1;    // mode `bursts`: a slow moment has the probability 2^-bits
  Occasions slow_moments_;
  std::array<Occasions, fault_kinds_count> faults_;
};

}  // namespace ltsim
