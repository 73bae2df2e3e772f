// One thread of control of the simulated world: a stack, and the thread-local storage that goes with it.
//
// A switch changes both, so `thread_local`, errno, pthread_self() and exceptions in flight are right in every
// task. Costs: about twenty instructions and one write of the FS base; bench/ shows the sum. x86-64, System V ABI.
//
// Floating-point rounding, masks and exception flags are a thread's own, too. Reading and writing them takes as
// long as all the rest, so they are exchanged only in a program that has touched them by <cfenv>.
#pragma once

#include <array>
#include <cstdint>

namespace ltsim {

class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Prepares to run `entry` on the given stack with the given thread-local storage, from its beginning, and
  /// with the rounding of the caller.
  /// @param stack_top        one past the highest byte; a multiple of 16
  /// @param thread_pointer   value of the FS base, from TaskStorage
  /// @param entry            called with `argument`; must never return
  void prepare(void* stack_top, void* thread_pointer, void (*entry)(void*), void* argument) noexcept;

  /// Makes this the context of the thread that calls, as it runs now.
  void adopt_current() noexcept;

  /// Suspends `from`, the running context, and resumes `to`. Returns when somebody resumes `from`.
  static void switch_between(Context& from, Context& to) noexcept;

  /// Somebody is about to look at or to change the floating-point environment: contexts have their own ones from
  /// now on, in this and all later executions.
  static void exchange_float_control_from_now_on() noexcept;

 private:
  // Of a new thread: System V ABI for x86-64, 3.4.1.
  static constexpr std::uint32_t mxcsr_at_begin = 0x1f80;
  /// As fnstenv writes it.
  struct X87Environment {
    std::uint32_t control = 0x37f;
    std::uint32_t status = 0;
    std::uint32_t tags = 0xffff;  // all registers are empty, as they are at each call
    std::array<std::uint32_t, 4> last_operation{};
  };

  static void begin() noexcept;
  static void exchange_stacks(void** suspended, void* resumed) noexcept;
  static void exchange_float_control(Context& from, Context& to) noexcept;

  void* stack_pointer_ = nullptr;  // while suspended: where the registers are that a call preserves
  void* thread_pointer_ = nullptr;
  // While suspended, if they are exchanged:
  std::uint32_t mxcsr_ = mxcsr_at_begin;  // SSE control and status
  X87Environment x87_;
};

}  // namespace ltsim
