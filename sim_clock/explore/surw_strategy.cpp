#include "sim_clock/explore/surw_strategy.hpp"

#include <algorithm>

namespace ltsim {
namespace {

/// Words of four bytes are told apart within a segment.
std::uint64_t key_of(const Operation& operation) noexcept {
  const std::uint64_t place = operation.object == 0 ? 0 : operation.offset / 4;
  return std::uint64_t{is_memory_access(operation.kind)} << 63U | std::uint64_t{operation.object} << 32U |
         place;
}

}  // namespace

SamplingStrategy::TimeMode SurwStrategy::begin() noexcept {
  things_count_ = things_learned_count_;
  tasks_seen_ = tasks_learned_;
  interesting_ = draw_interesting();
  left_sum_ = 0;
  for (std::size_t task = 0; task < tasks_seen_; ++task) {
    left_[task] = expected_[interesting_][task];
    left_sum_ += left_[task];
    for (std::size_t thing = 0; thing < things_count_; ++thing) passed_[thing][task] = 0;
    passed_[everything][task] = 0;
  }
  next_ = draw_next();
  return generator().below(2) == 0 ? TimeMode::silence : TimeMode::bursts;
}

std::size_t SurwStrategy::draw_interesting() noexcept {
  if (things_count_ == 0 || generator().below(4) == 0) return everything;
  // Things of one task only order nothing.
  std::array<std::size_t, things_max> shared{};
  std::uint32_t shared_count = 0;
  for (std::size_t thing = 0; thing < things_count_; ++thing) {
    std::size_t users = 0;
    for (std::size_t task = 0; task < tasks_seen_; ++task) users += expected_[thing][task] != 0 ? 1 : 0;
    if (users > 1) shared[shared_count++] = thing;
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
  return nobody;
}

void SurwStrategy::learn(const ExecutionSummary& summary) noexcept {
  SamplingStrategy::learn(summary);
  const auto learn_one = [this](std::size_t thing) {
    for (std::size_t task = 0; task < tasks_seen_; ++task) {
      std::uint32_t& expected = expected_[thing][task];
      expected = std::max(passed_[thing][task], expected - (expected + 15) / 16);
    }
  };
  for (std::size_t thing = 0; thing < things_count_; ++thing) learn_one(thing);
  learn_one(everything);
  things_learned_count_ = things_count_;
  tasks_learned_ = tasks_seen_;
}

std::size_t SurwStrategy::choose_task(const TaskChoice& choice) noexcept {
  std::array<std::size_t, tasks_max> candidates;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < choice.options.size(); ++i) {
    const std::uint64_t task = choice.options[i];
    const bool waits = next_ != nobody && task != next_ && is_interesting(choice.pending[task]);
    if (!waits && !(choice.running_gives_way && task == choice.running)) candidates[count++] = i;
  }
  if (count == 0) return generator().below(static_cast<std::uint32_t>(choice.options.size()));
  return candidates[count == 1 ? 0 : generator().below(count)];
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
  const std::size_t thing = thing_of(operation);
  if (thing == everything) return;
  ++passed_[thing][task];
  ++passed_[everything][task];
  if (interesting_ != everything && interesting_ != thing) return;
  if (left_[task] != 0) {
    --left_[task];
    --left_sum_;
  }
  next_ = draw_next();
}

std::size_t SurwStrategy::thing_of(const Operation& operation) noexcept {
  if (operation.object == 0 && !is_memory_access(operation.kind)) return everything;
  const std::uint64_t key = key_of(operation);
  for (std::size_t thing = 0; thing < things_count_; ++thing) {
    if (keys_[thing] == key) return thing;
  }
  if (things_count_ == things_max) return things_max - 1;
  keys_[things_count_] = key;
  passed_[things_count_].fill(0);
  expected_[things_count_].fill(0);
  return things_count_++;
}

bool SurwStrategy::is_interesting(const Operation& operation) noexcept {
  const std::size_t thing = thing_of(operation);
  return thing != everything && (interesting_ == everything || interesting_ == thing);
}

}  // namespace ltsim
