#include "sim_clock/explore/shared_things.hpp"

#include <algorithm>

#include "sim_clock/explore/random_generator.hpp"

namespace ltsim {
namespace {

/// Never 0; 0 stands for "no thing".
std::uint64_t key_of(const Operation& operation) noexcept {
  enum Kind : std::uint64_t { nothing, word, object, atomics, conditions };
  const auto key = [&](Kind kind, std::uint64_t place) {
    return std::uint64_t{kind} << 56U | std::uint64_t{operation.object} << 32U | place;
  };
  if (is_memory_access(operation.kind))
    return operation.object == 0 ? key(atomics, 0) : key(word, operation.offset / 4);
  if (operation.object != 0) return key(object, 0);
  return operation.offset != 0 ? key(conditions, 0) : 0;
}

}  // namespace

void SharedThings::begin() noexcept {
  std::copy_n(learned_users_.begin(), learned_count_, users_.begin());
  if (count_ == learned_count_) return;
  count_ = learned_count_;
  slots_.fill(0);
  for (std::size_t thing = 0; thing < count_; ++thing) {
    std::size_t slot = splitmix64(keys_[thing]) % slots_count;
    while (slots_[slot] != 0) slot = (slot + 1) % slots_count;
    slots_[slot] = static_cast<std::uint8_t>(thing + 1);
  }
}

void SharedThings::learn() noexcept {
  learned_count_ = count_;
  std::copy_n(users_.begin(), count_, learned_users_.begin());
}

std::size_t SharedThings::thing_of(const Operation& operation) noexcept {
  const std::uint64_t key = key_of(operation);
  if (key == 0) return none;
  std::size_t slot = splitmix64(key) % slots_count;
  for (; slots_[slot] != 0; slot = (slot + 1) % slots_count) {
    const std::size_t thing = slots_[slot] - std::size_t{1};
    if (keys_[thing] == key) return thing;
  }
  if (operation.object >= first_program_object && !operation.is_contended) return none;
  if (count_ == things_max) return things_max - 1;
  keys_[count_] = key;
  users_[count_] = nobody;
  learned_users_[count_] = nobody;
  slots_[slot] = static_cast<std::uint8_t>(count_ + 1);
  return count_++;
}

}  // namespace ltsim
