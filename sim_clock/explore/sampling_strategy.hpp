// What all randomised strategies have in common: a generator, and how they let time pass, let faults strike
// and answer questions. They differ in how they choose tasks.
//
// Time. In each execution it passes in one of these ways while somebody could run:
//   bursts   with the same probability, 2^-3 to 2^-13, at each point: the machine, or the one task at hand;
//   silence  one to three times, each before an operation drawn uniformly from those of the whole execution
//            that matter;
//   clock    the clock takes part like a task: it "runs" by going on to the next timer, when the strategy
//            chooses it (clock_goes_first()); at most 8, 16 ... 1024 times, drawn for each execution: a peer that
//            polls for ever must not keep the one it waits for from running for ever.
// A slow moment lasts for a time drawn log-uniformly from 1 us to 2 s, or for a multiple of the time to the next
// timer, or of the last such time known: an answer that is five time-outs late is one decision. Nobody who could run is held
// up for more than 16 s at a time: that is no slow machine any more.
//
// What matters. In three executions of four the strategies give their attention to operations on things that
// several tasks use (SharedThings), as far as the executions before have shown; in the fourth to all. Plain accesses of whole programs
// that do not race with what has been are passed over in the three, but not by the random walk.
//
// Weak memory. In one execution of four each load sees the latest store; in the others an older one with the same probability, 2^-1
// to 2^-4, each time that it may, all that it may see alike. Where that is so in half of these, a task that has seen an
// older store of a place goes on to see it for so many loads, 1 to 64, log-uniformly: a store that becomes visible late is
// one decision.
//
// Faults. Of the kinds that are granted, each is on in three executions of four, and then strikes at places
// drawn uniformly from its occasions.
#pragma once

#include <array>

#include "sim_clock/explore/occasions.hpp"
#include "sim_clock/explore/random_generator.hpp"
#include "sim_clock/explore/shared_things.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

/// What the executions so far have shown of a program, whichever strategy made their choices.
struct Experience {
  SharedThings things;
  SimTime period{0};          ///< the last time to the next timer that was seen; 0: none yet
  SimTime period_learned{0};  ///< the same at the end of the last execution that counts
  std::array<Occasions, fault_kinds_count> faults;
};

class SamplingStrategy : public Strategy {
 public:
  SamplingStrategy() = default;
  SamplingStrategy(const SamplingStrategy&) = delete;
  SamplingStrategy& operator=(const SamplingStrategy&) = delete;

  /// Learns together with others; `experience` must outlive the strategy.
  void share(Experience& experience) noexcept { experience_ = &experience; }

  void begin_execution(std::uint64_t seed) noexcept final;
  void learn(const ExecutionSummary& summary) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept final;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept final;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept final;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept final;
  [[nodiscard]] bool passes_uncontended() const noexcept override { return !all_matters_; }

 protected:
  enum class TimeMode : std::uint8_t { bursts, silence, clock };

  /// Draws what the kind of strategy needs for an execution. @return how time passes in it
  virtual TimeMode begin() noexcept = 0;
  /// Each of the three: the clock in five executions of eight, bursts in one of sixteen.
  [[nodiscard]] TimeMode draw_time_mode() noexcept;
  /// For begin(): the clock goes first at most so often in this execution.
  void limit_clock_turns(std::uint32_t turns) noexcept { clock_turns_left_ = turns; }
  /// In time mode `clock`, with a timer armed: whether time goes on to the next timer before anybody runs.
  [[nodiscard]] virtual bool clock_goes_first(const SlowMomentChoice& /*choice*/) noexcept { return false; }

  /// A strategy that follows steps tells what `task` uses. @return which of the things() it is, or none
  std::size_t note_use(TaskId task, const Operation& operation) noexcept;
  /// Whether the order of the operation among those of other tasks is worth a decision in this execution.
  [[nodiscard]] bool matters(const Operation& operation) noexcept;

  [[nodiscard]] bool all_matters() const noexcept { return all_matters_; }
  [[nodiscard]] const SharedThings& things() const noexcept { return experience_->things; }
  [[nodiscard]] std::size_t thing_of(const Operation& operation) noexcept {
    return experience_->things.thing_of(operation);
  }
  [[nodiscard]] RandomGenerator& generator() noexcept { return generator_; }

 private:
  [[nodiscard]] SlowMoment draw_slow_moment() noexcept;
  [[nodiscard]] Occasions& slow_moments() noexcept {
    return all_matters_ ? slow_moments_where_all_matters_ : slow_moments_;
  }

  RandomGenerator generator_{0};
  TimeMode time_mode_ = TimeMode::bursts;
  std::uint32_t clock_turns_left_ = 0;
  unsigned burst_bits_ = 1;  // mode `bursts`: a slow moment has the probability 2^-bits
  struct Staleness {
    bool drawn =
        false;  // what follows; only where it is asked for: choices of other executions stay as they were
    unsigned bits = 0;       // an older store has the probability 2^-bits; 0: it is never seen
    bool goes_on = false;    // with the same store, for some loads
    TaskId task = 0;         // whose loads those are
    std::uint32_t left = 0;  // of them
  };
  Staleness staleness_;                 // of this execution
  std::uint32_t faults_asked_for_ = 0;  // in this execution; a bit for each kind, whose places are drawn then
  Experience own_experience_;
  Experience* experience_ = &own_experience_;
  bool all_matters_ = false;
  // The two kinds of executions have numbers of occasions of their own.
  Occasions slow_moments_;
  Occasions slow_moments_where_all_matters_;
};

}  // namespace ltsim
