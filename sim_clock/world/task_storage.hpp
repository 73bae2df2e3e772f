// The thread-local storage of one task, and its stack; both are kept for the next execution.
//
// The storage is a block as glibc makes it for a new thread, so that every `thread_local` of the program and
// of its libraries, errno and pthread_self() are the task's own. reset() puts the thread-locals of the
// program and of all libraries but libc itself back to their initial values; libc's stay, because malloc
// keeps its per-thread cache there.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ltsim {

class StateHash;

class TaskStorage {
 public:
  static constexpr std::size_t stack_bytes = 256 * 1024;

  /// Below each stack: large enough that no ordinary frame of a function jumps over it.
  static constexpr std::size_t guard_bytes = 8 * 1024 * 1024;

  /// Maps the stack (with guard_bytes without access below it) and allocates the thread-local block.
  TaskStorage();
  ~TaskStorage();
  TaskStorage(const TaskStorage&) = delete;
  TaskStorage& operator=(const TaskStorage&) = delete;

  /// Initial values for every thread-local but those of libc; errno = 0.
  void reset() noexcept;
  /// All that reset() resets.
  void add_state(StateHash& hash) const noexcept;
  /// Fills with zeros what lies below the stack pointer of a task that stands still: what comes after finds none of the words of what
  /// was called before.
  /// @param stack_pointer  in the stack, or its top
  /// @param bytes_max      so much, or to the stack's end
  void clean_stack_below(void* stack_pointer, std::size_t bytes_max) const noexcept;
  /// Whether the address lies in the stack or among the thread-locals.
  [[nodiscard]] bool contains(std::uintptr_t address) const noexcept;

  [[nodiscard]] void* thread_pointer() const noexcept { return thread_pointer_; }
  [[nodiscard]] void* stack_top() const noexcept { return stack_top_; }
  [[nodiscard]] bool on_guard(const void* address) const noexcept;
  /// Whether a value of pthread_t, or of the FS base, belongs to a task of this program, of whichever
  /// execution.
  [[nodiscard]] static bool is_of_a_task(const void* thread_pointer) noexcept;

  /// To be called once on the new stack, with the new storage in place, before any other code runs there.
  static void finish_set_up_of_current() noexcept;

 private:
  void* stack_base_ = nullptr;
  void* stack_top_ = nullptr;
  void* thread_pointer_ = nullptr;
};

}  // namespace ltsim
