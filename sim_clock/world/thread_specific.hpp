// Values of threads by keys: pthread_key_create(3).
//
// Keys are the program's, and so are known to all processes of a world: they are one program, and have the variables in common in which
// it keeps them. Values are a task's, and a new execution begins without any. As with every variable, a key that was made in an earlier
// execution, and that the program does not make again, is still there; so a key that is made into a static variable is the same
// each time, and other keys have numbers in the order in which an execution makes them, but for those that were used without being made
// in it.
//
// Keys made outside of tasks are libc's (number < PTHREAD_KEYS_MAX); tasks have values for them here, too.
//
// Left out: what happens when the same static variable is given a second key in one execution while the first one is still in use; its
// values are lost.
#pragma once

#include <pthread.h>

#include <array>
#include <cstdint>
#include <vector>

#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;

class ThreadSpecific {
 public:
  using Destructor = void (*)(void*);
  /// Of one process, at a time, as glibc has them.
  static constexpr std::size_t keys_max = 1024;

  void reset() noexcept {
    if (any_used_) forget();
  }

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them. None is a scheduling point:
  // what they do is nobody else's business.
  int create(pthread_key_t* key, Destructor destructor);
  int remove(pthread_key_t key) noexcept;
  int set(pthread_key_t key, const void* value);
  [[nodiscard]] void* get(pthread_key_t key) noexcept;

  /// At the task's end: destructors of all values that are not null, in the order of the keys' numbers, again while there are
  /// any, PTHREAD_DESTRUCTOR_ITERATIONS times at most.
  void destroy_values(Task& task);

  /// Outside of any task libc has made a key.
  static void was_made_by_libc(pthread_key_t key, Destructor destructor);
  static void was_removed_by_libc(pthread_key_t key) noexcept;
  /// Whether a task made it; outside any task it is nobody's then.
  [[nodiscard]] static bool is_ours(pthread_key_t key) noexcept { return key >= first_key; }

 private:
  static constexpr pthread_key_t first_key = pthread_key_t{1} << 16U;

  struct Life {
    std::uint32_t number = 0;  // of those that the key has had in this process and execution
    bool has_ended = false;
  };
  struct Key {
    Destructor destructor = nullptr;
    const void* variable = nullptr;  // a static one that the key was made into
    bool exists = false;
    bool stays = false;    // used in an execution that had not made it
    bool is_made = false;  // in this execution, by whichever process
    std::array<Life, processes_max> lives{};
  };
  struct Value {
    pthread_key_t key;
    std::uint32_t life;
    void* value;
  };

  void forget() noexcept;
  /// @return null for a number that is no key of the running task's process
  [[nodiscard]] Key* find(pthread_key_t key) noexcept;
  [[nodiscard]] Value* find_value(TaskId task, pthread_key_t key) noexcept;
  [[nodiscard]] static Life& life_of(Key& key, ProcessId process) noexcept { return key.lives[process]; }

  // As long as the program lives, like the variables that hold the numbers.
  static inline std::vector<Key> keys_;
  static inline std::vector<Key> keys_of_libc_;

  std::array<std::vector<Value>, tasks_max> values_;
  bool any_used_ = false;  // in this execution
};

}  // namespace ltsim
