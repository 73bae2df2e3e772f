#include "sim_clock/explore/causal_hash.hpp"

#include <bit>

#include "sim_clock/explore/random_generator.hpp"

namespace ltsim {
namespace {

std::uint64_t joined(std::uint64_t one, std::uint64_t other) noexcept {
  return std::rotl((one ^ other) * 0x9e3779b97f4a7c15U, 29);
}

/// Steps that concern their task alone.
bool acts_on_nothing(OperationKind kind) noexcept {
  return kind == OperationKind::clock_read || kind == OperationKind::sleep || kind == OperationKind::yield ||
         kind == OperationKind::thread_start || kind == OperationKind::thread_end;
}

}  // namespace

void CausalHash::reset() noexcept {
  ++generation_;
  last_of_task_.fill(0);
  sum_ = 0;
}

void CausalHash::add(TaskId task, const Operation& operation) noexcept {
  // An address without object means nothing in another execution: it tells places apart and is not hashed.
  const std::uint32_t offset = operation.object == 0 ? 0 : operation.offset;
  const std::uint64_t step = std::uint64_t{task} << 48U ^
                             std::uint64_t{static_cast<std::uint8_t>(operation.kind)} << 40U ^
                             std::uint64_t{operation.object} << 32U ^ offset;
  std::uint64_t hash = joined(last_of_task_[task] + 1, step);
  if (is_memory_access(operation.kind)) {
    constexpr std::uint32_t bytes_of_a_place = 8;
    const bool changes = changes_memory(operation.kind);
    const std::uint64_t object = std::uint64_t{operation.object} << 32U | std::uint64_t{1} << 63U;
    const std::uint32_t last =
        (operation.offset + operation.bytes - (operation.bytes == 0 ? 0U : 1U)) / bytes_of_a_place;
    for (std::uint32_t at = operation.offset / bytes_of_a_place; at <= last; ++at) {
      const Place& acted_on = place(object | at);
      hash = joined(hash, acted_on.change);
      if (changes) hash = joined(hash, acted_on.looks);
    }
    for (std::uint32_t at = operation.offset / bytes_of_a_place; at <= last; ++at) {
      Place& acted_on = place(object | at);
      if (changes) {
        acted_on.change = hash;
        acted_on.looks = 0;
      } else {
        acted_on.looks += hash;
      }
    }
  } else if (!acts_on_nothing(operation.kind)) {
    // What names no object (opening, mapping, creating threads) acts on the system as a whole.
    Place& acted_on =
        place(operation.object != 0 ? operation.object : std::uint64_t{1} << 62U | operation.offset);
    hash = joined(hash, acted_on.change);
    acted_on.change = hash;
  }
  last_of_task_[task] = hash;
  sum_ += splitmix64(hash);
}

void CausalHash::add_age(TaskId task, std::uint32_t age) noexcept {
  std::uint64_t& last = last_of_task_[task];
  last = joined(last, age);
  sum_ += splitmix64(last);
}

CausalHash::Place& CausalHash::place(std::uint64_t key) noexcept {
  std::size_t slot = splitmix64(key) % places_max;
  for (unsigned probes = 0; probes < 8; ++probes, slot = (slot + 1) % places_max) {
    Place& found = places_[slot];
    if (found.generation == generation_ && found.key != key) continue;
    if (found.generation != generation_) found = Place{.key = key, .generation = generation_};
    return found;
  }
  return places_[slot];
}

}  // namespace ltsim
