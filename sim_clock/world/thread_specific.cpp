#include "sim_clock/world/thread_specific.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <utility>

#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

/// In a variable of the program or of one of its libraries.
bool is_static(const void* address) noexcept {
  Dl_info info;
  return dladdr(address, &info) != 0;
}

}  // namespace

void ThreadSpecific::forget() noexcept {
  any_used_ = false;
  for (auto& of_task : values_) of_task.clear();
  for (auto* const all : {&keys_, &keys_of_libc_}) {
    for (Key& key : *all) {
      key.is_made = false;
      key.lives.fill({});
    }
  }
}

ThreadSpecific::Key* ThreadSpecific::find(pthread_key_t number) noexcept {
  std::vector<Key>& all = is_ours(number) ? keys_ : keys_of_libc_;
  const std::size_t index = is_ours(number) ? number - first_key : number;
  if (index >= all.size() || !all[index].exists) return nullptr;
  any_used_ = true;
  Key& key = all[index];
  return life_of(key, current_task->process).has_ended ? nullptr : &key;
}

int ThreadSpecific::create(pthread_key_t* into, Destructor destructor) {
  const ProcessId process = current_task->process;
  const GhostScope ghost;
  std::vector<Key>& all = keys_;
  const void* const variable = is_static(into) ? into : nullptr;
  auto found = all.end();
  if (variable != nullptr) {
    found = std::find_if(all.begin(), all.end(), [&](const Key& key) { return key.variable == variable; });
  } else {
    found = std::find_if(all.begin(), all.end(), [&](Key& key) {
      return key.variable == nullptr && !key.stays && (!key.is_made || life_of(key, process).has_ended);
    });
  }
  if (found == all.end()) {
    if (all.size() >= keys_max) return EAGAIN;
    found = all.emplace(all.end());
  }
  found->destructor = destructor;
  found->variable = variable;
  found->exists = true;
  found->is_made = true;
  any_used_ = true;
  Life& life = life_of(*found, process);
  life = {.number = life.number + 1, .has_ended = false};
  *into = first_key + static_cast<pthread_key_t>(found - all.begin());
  return 0;
}

int ThreadSpecific::remove(pthread_key_t number) noexcept {
  Key* const key = find(number);
  if (key == nullptr) return EINVAL;
  life_of(*key, current_task->process).has_ended = true;
  return 0;
}

ThreadSpecific::Value* ThreadSpecific::find_value(TaskId task, pthread_key_t key) noexcept {
  auto& all = values_[task];
  const auto found =
      std::find_if(all.begin(), all.end(), [key](const Value& each) { return each.key == key; });
  return found == all.end() ? nullptr : &*found;
}

int ThreadSpecific::set(pthread_key_t number, const void* value) {
  Key* const key = find(number);
  if (key == nullptr) return EINVAL;
  key->stays = key->stays || !key->is_made;
  const Value written{
      .key = number, .life = life_of(*key, current_task->process).number, .value = const_cast<void*>(value)};
  const TaskId self = current_task->id;
  const GhostScope ghost;
  if (Value* const before = find_value(self, number)) {
    *before = written;
  } else {
    auto& all = values_[self];
    all.insert(
        std::find_if(all.begin(), all.end(), [number](const Value& each) { return each.key > number; }),
        written);
  }
  return 0;
}

void* ThreadSpecific::get(pthread_key_t number) noexcept {
  Key* const key = find(number);
  if (key == nullptr) return nullptr;
  key->stays = key->stays || !key->is_made;
  const Value* const value = find_value(current_task->id, number);
  return value == nullptr || value->life != life_of(*key, current_task->process).number ? nullptr
                                                                                        : value->value;
}

void ThreadSpecific::destroy_values(Task& task) {
  for (int round = 0; round < PTHREAD_DESTRUCTOR_ITERATIONS; ++round) {
    bool any = false;
    // A destructor may set others, and make the list longer.
    for (std::size_t i = 0; i < values_[task.id].size(); ++i) {
      Value& value = values_[task.id][i];
      Key* const key = find(value.key);
      if (key == nullptr || key->destructor == nullptr || value.life != life_of(*key, task.process).number)
        continue;
      void* const destroyed = std::exchange(value.value, nullptr);
      if (destroyed == nullptr) continue;
      any = true;
      key->destructor(destroyed);
    }
    if (!any) return;
  }
}

void ThreadSpecific::was_made_by_libc(pthread_key_t number, Destructor destructor) {
  if (number >= keys_of_libc_.size()) keys_of_libc_.resize(number + 1);
  keys_of_libc_[number] = {};
  keys_of_libc_[number].destructor = destructor;
  keys_of_libc_[number].exists = true;
}

void ThreadSpecific::was_removed_by_libc(pthread_key_t number) noexcept {
  if (number < keys_of_libc_.size()) keys_of_libc_[number].exists = false;
}

void ThreadSpecific::add_state(StateHash& hash) const noexcept {
  for (const auto* const all : {&keys_, &keys_of_libc_}) {
    for (const Key& key : *all) {
      std::uint64_t lives = 0;
      for (const Life& life : key.lives) lives = lives * 31 + life.number * 2 + (life.has_ended ? 1 : 0);
      if (lives == 0) continue;
      hash.add(static_cast<std::uint64_t>(&key - all->data()));
      hash.add(lives);
      hash.add(reinterpret_cast<std::uintptr_t>(key.destructor));
    }
  }
  for (const auto& of_task : values_) {
    for (const Value& value : of_task) {
      if (value.value == nullptr) continue;
      hash.add(std::uint64_t{value.key} << 32U | value.life);
      hash.add_word(reinterpret_cast<std::uintptr_t>(value.value));
    }
  }
}

}  // namespace ltsim
