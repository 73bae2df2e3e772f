#include "sim_clock/explore/surw_strategy.hpp"

#include <algorithm>

#include "sim_clock/explore/task_set.hpp"

namespace ltsim {

SamplingStrategy::TimeMode SurwStrategy::begin() noexcept {
  tasks_seen_ = tasks_learned_;
  interesting_ = draw_interesting();
  left_sum_ = 0;
  for (std::size_t task = 0; task < tasks_seen_; ++task) {
    left_[task] = expected_[interesting_][task];
    left_sum_ += left_[task];
    for (auto& counts : passed_) counts[task] = 0;
  }
  clock_left_ = 0;
  const TimeMode mode = draw_time_mode();
  if (mode == TimeMode::clock) clock_left_ = std::uint64_t{1} << generator().below(7);
  left_sum_ += clock_left_;
  next_ = draw_next();
  return mode;
}

std::size_t SurwStrategy::draw_interesting() noexcept {
  if (all_matters()) return everything;
  std::array<std::size_t, SharedThings::things_max> shared{};
  std::uint32_t shared_count = 0;
  for (std::size_t thing = 0; thing < things().count(); ++thing) {
    const auto& counts = expected_[thing];  // nothing, where another strategy has seen it
    const bool is_known =
        std::any_of(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(tasks_seen_),
                    [](std::uint32_t count) { return count != 0; });
    if (is_known && things().is_shared(thing)) shared[shared_count++] = thing;
  }
  return shared_count == 0 ? everything : shared[generator().below(shared_count)];
}

TaskId SurwStrategy::draw_next() noexcept {
  if (left_sum_ == 0) return nobody;
  std::uint64_t place = generator().below(static_cast<std::uint32_t>(left_sum_));
  for (std::size_t task = 0; task < tasks_seen_; ++task) {
    if (place < left_[task]) return static_cast<TaskId>(task);
    place -= left_[task];
  }
  return the_clock;
}

void SurwStrategy::learn(const ExecutionSummary& summary) noexcept {
  SamplingStrategy::learn(summary);
  const auto learn_one = [this](std::size_t thing) {
    for (std::size_t task = 0; task < tasks_seen_; ++task) {
      std::uint32_t& expected = expected_[thing][task];
      expected = std::max(passed_[thing][task], expected - (expected + 15) / 16);
    }
  };
  for (std::size_t thing = 0; thing < things().count(); ++thing) learn_one(thing);
  learn_one(everything);
  tasks_learned_ = tasks_seen_;
}

std::size_t SurwStrategy::choose_task(const TaskChoice& choice) noexcept {
  std::array<std::size_t, tasks_max> candidates;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < choice.options.size(); ++i) {
    const std::uint64_t task = choice.options[i];
    const bool waits = next_ != nobody && task != next_ && !contains(choice.under_way, task) &&
                       is_interesting(choice.pending[task]);
    if (!waits && !(choice.running_gives_way && task == choice.running)) candidates[count++] = i;
  }
  if (count == 0) return draw_waiting(choice);
  return candidates[count == 1 ? 0 : generator().below(count)];
}

std::size_t SurwStrategy::draw_waiting(const TaskChoice& choice) noexcept {
  std::uint64_t sum = 0;
  for (const std::uint64_t task : choice.options) sum += task < tasks_seen_ ? left_[task] : 0;
  if (sum == 0) return generator().below(static_cast<std::uint32_t>(choice.options.size()));
  std::uint64_t place = generator().below(static_cast<std::uint32_t>(sum));
  std::size_t i = 0;
  for (; i + 1 < choice.options.size(); ++i) {
    const std::uint64_t left = choice.options[i] < tasks_seen_ ? left_[choice.options[i]] : 0;
    if (place < left) break;
    place -= left;
  }
  return i;
}

bool SurwStrategy::clock_goes_first(const SlowMomentChoice& choice) noexcept {
  if (next_ == nobody) return false;
  bool all_wait = true;
  for_each_task(choice.runnable, [&](TaskId task) {
    all_wait = all_wait && task != next_ && !contains(choice.under_way, task) &&
               is_interesting(choice.pending[task]);
  });
  if (!all_wait) return false;
  if (next_ != the_clock) {
    // Whose turn it is sleeps: time goes on.
    if (contains(choice.runnable, next_) || clock_left_ == 0) return false;
  }
  --clock_left_;
  --left_sum_;
  if (next_ == the_clock) next_ = draw_next();
  return true;
}

void SurwStrategy::performs(TaskId task, const Operation& operation) noexcept {
  if (task >= tasks_seen_) {
    for (std::size_t fresh = tasks_seen_; fresh <= task; ++fresh) {
      left_[fresh] = 0;
      for (auto& counts : passed_) counts[fresh] = 0;
      for (auto& counts : expected_) counts[fresh] = 0;
    }
    tasks_seen_ = task + std::size_t{1};
  }
  const std::size_t thing = note_use(task, operation);
  if (thing == SharedThings::none) return;
  ++passed_[thing][task];
  ++passed_[everything][task];
  if (interesting_ != everything && interesting_ != thing) return;
  if (left_[task] != 0) {
    --left_[task];
    --left_sum_;
  }
  next_ = draw_next();
}

bool SurwStrategy::is_interesting(const Operation& operation) noexcept {
  const std::size_t thing = thing_of(operation);
  return thing != SharedThings::none && (interesting_ == everything || interesting_ == thing);
}

}  // namespace ltsim
