#include "sim_clock/explore/step_races.hpp"

#include <algorithm>

#include "sim_clock/world/world.hpp"

namespace ltsim {

void StepRaces::begin_execution() {
  steps_.clear();
  last_of_.assign(steppers_count, Step::none);
}

void StepRaces::add(const Step& step) {
  last_of_[step.stepper] = size();
  steps_.push_back(step);
}

bool StepRaces::depend(const Step& one, const Step& other) const noexcept {
  return one.stepper == other.stepper ||
         order_matters(one.effect, other.effect, world_.memory() == Memory::c11);
}

void StepRaces::find(DecisionPath& path) {
  // What came before the last decision was looked at when it was new.
  // An execution that should have been longer is no longer the one it was: DecisionPath::advance() says so.
  const std::uint32_t in_common = std::min(path.steps_in_common(), size());
  clocks_.resize(steps_.size() * steppers_count);
  std::fill(clocks_.begin() + static_cast<std::ptrdiff_t>(in_common * steppers_count), clocks_.end(), 0);
  std::vector<std::uint32_t> last(steppers_count, Step::none);
  for (std::uint32_t n = 0; n < steps_.size(); ++n) {
    const Step& step = steps_[n];
    if (n < in_common) {
      last[step.stepper] = n;
      continue;
    }
    std::uint32_t* const clock = clock_of(n);
    const auto join = [&](std::uint32_t earlier) {
      const std::uint32_t* const other = clock_of(earlier);
      for (std::size_t i = 0; i < steppers_count; ++i) clock[i] = std::max(clock[i], other[i]);
    };
    if (last[step.stepper] != Step::none) join(last[step.stepper]);
    if (step.follows != Step::none) join(step.follows);
    if (step.woken_by != Step::none) join(step.woken_by);
    // Where the two cannot change places, perhaps `step` can come before what came earlier still: who takes something cannot
    // come before it was given back, but before the one who took it then.
    const bool takes = step.effect.operation.kind == OperationKind::sem_wait ||
                       step.effect.operation.kind == OperationKind::mutex_lock;
    bool is_free_here = step.was_free;
    but_for_fixed_.assign(clock, clock + steppers_count);
    for (std::uint32_t e = n; e-- > 0;) {
      const Step& earlier = steps_[e];
      if (takes && earlier.effect.operation.object == step.effect.operation.object)
        is_free_here = earlier.was_free;
      if (but_for_fixed_[earlier.stepper] > e || !depend(earlier, step)) continue;
      const bool is_fixed = step.is_time || (takes && !is_free_here) || !reverse(path, e, n);
      join(e);
      if (is_fixed) continue;
      const std::uint32_t* const other = clock_of(e);
      for (std::size_t i = 0; i < steppers_count; ++i)
        but_for_fixed_[i] = std::max(but_for_fixed_[i], other[i]);
    }
    clock[step.stepper] = n + 1;
    last[step.stepper] = n;
  }
}

bool StepRaces::reverse(DecisionPath& path, std::uint32_t earlier, std::uint32_t later) {
  // Who can begin what did not have to come after `earlier`, and ends with `later`.
  TaskBits begins = 0;
  TaskBits seen = 0;
  std::vector<std::uint32_t> rest;
  for (std::uint32_t e = earlier + 1; e <= later; ++e) {
    const bool comes_after = e != later && happens_before(earlier, e);
    if (comes_after) continue;
    const std::size_t stepper = steps_[e].stepper;
    if ((seen & task_bit(stepper)) == 0) {
      const bool has_predecessor = std::any_of(rest.begin(), rest.end(), [&](std::uint32_t other) {
        return e == later ? clock_of(later)[steps_[other].stepper] > other : happens_before(other, e);
      });
      if (!has_predecessor) begins |= task_bit(stepper);
    }
    seen |= task_bit(stepper);
    rest.push_back(e);
  }
  // Faults strike wherever they can.
  if ((begins & task_bit(the_barrier)) != 0) return true;
  // There, or where one of them could last be chosen: what has happened in between does not matter to it.
  for (std::uint32_t d = steps_[earlier].decisions; d-- > 0;) {
    if (path.must_try_one_of(d, begins)) return true;
  }
  return false;
}

}  // namespace ltsim
