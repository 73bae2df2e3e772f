// The steps of one execution, and which of them race: those that nothing keeps in their order, though it matters.
//
// For each race the search must see the other order as well, if it can be: source sets (Abdulla, Aronis, Jonsson, Sagonas: Optimal
// Dynamic Partial Order Reduction, POPL 2014).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim_clock/explore/decision_path.hpp"
#include "sim_clock/explore/dependence.hpp"

namespace ltsim {

class World;

/// What takes a step, besides tasks: faults, and time that passes when nobody can run.
inline constexpr std::size_t the_barrier = search_tasks_max;

struct Step {
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  std::size_t stepper = 0;  ///< a task, or the_barrier
  StepEffect effect;
  std::uint32_t decisions = 0;    ///< how many there were before it
  std::uint32_t woken_by = none;  ///< one that is gone on with: the step that made that possible
  /// One that comes before it: it made the task, or was the last of one that is joined.
  std::uint32_t follows = none;
  bool is_time = false;  ///< that passes; it has to come here
  bool was_free = true;  ///< what it acts on, before, for those who take it: a mutex, a token of a semaphore
};

class StepRaces {
 public:
  /// @param world      whose tasks take them
  /// @param steps_max  an execution will not have many more
  StepRaces(const World& world, std::size_t steps_max) : world_(world) { steps_.reserve(steps_max + 64); }

  void begin_execution();

  void add(const Step& step);
  [[nodiscard]] bool empty() const noexcept { return steps_.empty(); }
  [[nodiscard]] std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(steps_.size()); }
  [[nodiscard]] Step& back() noexcept { return steps_.back(); }
  [[nodiscard]] const Step& back() const noexcept { return steps_.back(); }
  /// Its number; Step::none if there is none.
  [[nodiscard]] std::uint32_t last_of(std::size_t stepper) const noexcept { return last_of_[stepper]; }

  [[nodiscard]] bool depend(const Step& one, const Step& other) const noexcept;

  /// Adds to the decisions what must be tried there because of races.
  void find(DecisionPath& path);

 private:
  static constexpr std::size_t steppers_count = search_tasks_max + 1;

  /// Sees to it that `later` comes before `earlier`, too. @return whether that can be
  bool reverse(DecisionPath& path, std::uint32_t earlier, std::uint32_t later);
  [[nodiscard]] std::uint32_t* clock_of(std::size_t step) noexcept {
    return clocks_.data() + step * steppers_count;
  }
  [[nodiscard]] bool happens_before(std::size_t earlier, std::size_t later) noexcept {
    return clock_of(later)[steps_[earlier].stepper] > earlier;
  }

  const World& world_;
  std::vector<Step> steps_;
  // By step: per stepper, one more than its last step that happens before.
  std::vector<std::uint32_t> clocks_;
  std::vector<std::uint32_t> but_for_fixed_;  // a clock that is being made
  std::vector<std::uint32_t> last_of_;        // by stepper: its last step
};

}  // namespace ltsim
