#include "sim_clock/explore/pct_strategy.hpp"

#include "sim_clock/explore/task_set.hpp"

namespace ltsim {
namespace {

constexpr std::uint64_t drawn_bit = std::uint64_t{1} << 63U;

}  // namespace

SamplingStrategy::TimeMode PctStrategy::begin() noexcept {
  priorities_.fill(0);
  next_lower_ = drawn_bit - 1;
  std::size_t change_points_count = 0;  // d - 1
  while (change_points_count < 5 && generator().below(3) != 0) ++change_points_count;
  change_points().begin(generator(), change_points_count);
  // Priorities change seldom: without an end to its turns a clock that goes first does so for good.
  limit_clock_turns(std::uint32_t{1} << generator().below(8));
  return draw_time_mode();
}

void PctStrategy::learn(const ExecutionSummary& summary) noexcept {
  SamplingStrategy::learn(summary);
  change_points().learn();
}

std::size_t PctStrategy::choose_task(const TaskChoice& choice) noexcept {
  if (choice.running_gives_way) lower(choice.running);
  std::size_t best = 0;
  for (std::size_t i = 1; i < choice.options.size(); ++i) {
    if (priority_of(choice.options[i]) > priority_of(choice.options[best])) best = i;
  }
  return best;
}

bool PctStrategy::clock_goes_first(const SlowMomentChoice& choice) noexcept {
  bool first = true;
  for_each_task(choice.runnable,
                [&](TaskId task) { first = first && priority_of(clock) > priority_of(task); });
  if (first && change_points().pass() != 0) lower(clock);
  return first;
}

void PctStrategy::performs(TaskId task, const Operation& operation) noexcept {
  note_use(task, operation);
  if (matters(operation) && change_points().pass() != 0) lower(task);
}

std::uint64_t PctStrategy::priority_of(std::size_t task) noexcept {
  if (priorities_[task] == 0) priorities_[task] = generator().next() | drawn_bit;
  return priorities_[task];
}

void PctStrategy::lower(std::size_t task) noexcept { priorities_[task] = next_lower_--; }

}  // namespace ltsim
