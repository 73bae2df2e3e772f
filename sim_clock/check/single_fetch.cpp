#include "sim_clock/check/single_fetch.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

bool ends_transaction(OperationKind kind) noexcept {
  switch (kind) {
    case OperationKind::sem_wait:
    case OperationKind::sem_trywait:
    case OperationKind::sem_timedwait:
    case OperationKind::sem_post:
    case OperationKind::mutex_lock:
    case OperationKind::mutex_trylock:
    case OperationKind::mutex_timedlock:
    case OperationKind::mutex_unlock:
    case OperationKind::cond_wait:
    case OperationKind::cond_timedwait:
    case OperationKind::cond_signal:
    case OperationKind::cond_broadcast:
    case OperationKind::futex_wait:
    case OperationKind::futex_wake:
    case OperationKind::once:
    case OperationKind::thread_join:
    case OperationKind::sleep:
    case OperationKind::yield:
    case OperationKind::rwlock_rdlock:
    case OperationKind::rwlock_tryrdlock:
    case OperationKind::rwlock_timedrdlock:
    case OperationKind::rwlock_wrlock:
    case OperationKind::rwlock_trywrlock:
    case OperationKind::rwlock_timedwrlock:
    case OperationKind::rwlock_unlock:
    case OperationKind::spin_lock:
    case OperationKind::spin_trylock:
    case OperationKind::spin_unlock:
    case OperationKind::barrier_wait:
    case OperationKind::static_init:
    case OperationKind::thread_tryjoin:
    case OperationKind::thread_timedjoin:
    case OperationKind::signal_wait:
    case OperationKind::signal_send:
    case OperationKind::semop:
    case OperationKind::semop_nowait:
    case OperationKind::semctl:
      return true;
    default:
      return false;
  }
}

}  // namespace

void SingleFetch::declare(std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                          std::string_view name) {
  if (bytes == 0 || bytes > word_bytes_max) {
    world_.unsupported(fmt::format("single_fetch of {} bytes: a word has 1 to {}", bytes, word_bytes_max));
    return;
  }
  if (words_count_ == words_.size()) words_.emplace_back();
  Word& word = words_[words_count_++];
  word.segment.assign(segment);
  word.offset = offset;
  word.bytes = bytes;
  word.name.assign(name);
  word.fetches.fill({});
}

void SingleFetch::performs(const Task& task, const Operation& operation) noexcept {
  const bool is_access = is_memory_access(operation.kind);
  if (!is_access && !ends_transaction(operation.kind)) return;
  for (std::size_t i = 0; i < words_count_; ++i) {
    Word& word = words_[i];
    Fetch& fetch = word.fetches[task.id];
    if (!is_access) {
      fetch = {};
      continue;
    }
    const std::uint32_t begin = std::max(word.offset, operation.offset);
    const std::uint32_t end = std::min(word.offset + word.bytes, operation.offset + operation.bytes);
    if (operation.object == 0 || begin >= end) continue;
    if (world_.objects().object_name(operation.object) != word.segment) continue;
    if (changes_memory(operation.kind)) {
      fetch = {};
      continue;
    }
    const auto loaded = static_cast<std::uint8_t>(((1U << (end - begin)) - 1U) << (begin - word.offset));
    const std::uint64_t value = world_.segments().value_at({.kind = OperationKind::read,
                                                            .bytes = static_cast<std::uint8_t>(word.bytes),
                                                            .object = operation.object,
                                                            .offset = word.offset});
    if ((fetch.bytes_loaded & loaded) != 0) loaded_twice(word, task, fetch.value, value);
    fetch.bytes_loaded |= loaded;
    fetch.value = value;
  }
}

void SingleFetch::loaded_twice(const Word& word, const Task& task, std::uint64_t first,
                               std::uint64_t second) {
  const GhostScope ghost;
  world_.violated(fmt::format(
      "{} was loaded twice in one transaction by {}: {}", word.name, task.name,
      first == second ? fmt::format("{} both times", first) : fmt::format("{}, then {}", first, second)));
  LTSIM_UNREACHABLE("a task goes on after a failure");
}

void SingleFetch::add_state(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < words_count_; ++i) {
    for (std::size_t task = 0; task < world_.scheduler().tasks_count(); ++task) {
      // It loads nothing any more.
      const Task::State state = world_.scheduler().task(static_cast<TaskId>(task)).state;
      if (state == Task::State::killed || state == Task::State::finished) continue;
      hash.add(words_[i].fetches[task].bytes_loaded);
      hash.add(words_[i].fetches[task].value);
    }
  }
}

}  // namespace ltsim
