// The thread-local storage of one task, and its stack; both are kept for the next execution.
//
// The storage is a block as glibc makes it for a new thread, so that every `thread_local` of the program and
// of its libraries, errno and pthread_self() are the task's own. reset() puts the thread-locals of the
// program and of all libraries but libc itself back to their initial values; libc's stay, because malloc
// keeps its per-thread cache there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ltsim {

class StateHash;

class TaskStorage {
 public:
  static constexpr std::size_t stack_bytes = std::size_t{1} << 20U;

  /// Each stack lies at the end of a slot of its own in one range. Below it nothing can be accessed: large enough that no ordinary
  /// frame of a function jumps over it.
  static constexpr unsigned slot_shift = 24;
  static constexpr std::size_t slots_count = 512;
  static constexpr std::uintptr_t range_begin = std::uintptr_t{1} << 41U;
  static constexpr std::size_t range_bytes = slots_count << slot_shift;

  /// Maps the stack and allocates the thread-local block.
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
  /// Calls `visit` with each whole word of the thread-locals that reset() resets.
  template <typename Visit>
  void visit_thread_locals(const Visit& visit) const {
    for (const std::ptrdiff_t from_thread_pointer : thread_local_words())
      visit(*reinterpret_cast<const std::uintptr_t*>(static_cast<const char*>(thread_pointer_) +
                                                     from_thread_pointer));
  }
  /// Whether the address lies in the stack or among the thread-locals.
  [[nodiscard]] bool contains(std::uintptr_t address) const noexcept;

  [[nodiscard]] void* thread_pointer() const noexcept { return thread_pointer_; }
  [[nodiscard]] void* stack_top() const noexcept { return stack_top_; }
  [[nodiscard]] std::size_t slot() const noexcept {
    return (reinterpret_cast<std::uintptr_t>(stack_base_) - range_begin) >> slot_shift;
  }
  /// Whether the address lies in the range of the stacks.
  [[nodiscard]] static bool is_in_range(std::uintptr_t address) noexcept {
    return address - range_begin < range_bytes;
  }
  [[nodiscard]] bool on_guard(const void* address) const noexcept;
  /// Whether a value of pthread_t, or of the FS base, belongs to a task of this program, of whichever
  /// execution.
  [[nodiscard]] static bool is_of_a_task(const void* thread_pointer) noexcept;

  /// To be called once on the new stack, with the new storage in place, before any other code runs there.
  static void finish_set_up_of_current() noexcept;

 private:
  [[nodiscard]] static const std::vector<std::ptrdiff_t>& thread_local_words();

  void* stack_base_ = nullptr;  // of the slot
  void* stack_top_ = nullptr;
  void* thread_pointer_ = nullptr;
};

}  // namespace ltsim
