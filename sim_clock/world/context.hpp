// One thread of control of the simulated world: a stack, and the thread-local storage that goes with it.
//
// A switch changes both, so `thread_local`, errno, pthread_self() and exceptions in flight are right in every
// task. Costs: about ten instructions and one write of the FS base; bench/ shows the sum. x86-64, System V ABI.
//
// Floating-point rounding, masks and exception flags are a thread's own, too. Reading and writing them takes as
// long as all the rest, so they are exchanged only in a program that has touched them by <cfenv>.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

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
  /// Part of its caller: a call that returns on another stack than it was made on shifts what the processor foresees
  /// of all returns above it. Of the registers, those of the vector extensions beyond SSE must be out of use, as at a call.
  [[gnu::always_inline]] static inline void switch_between(Context& from, Context& to) noexcept {
    if (float_control_matters_) [[unlikely]]
      exchange_float_control(from, to);
    set_thread_pointer(to.thread_pointer_);
    // All registers but two are said to change, so the compiler keeps what it needs on the stack, and that is little.
    void* resumed = &to.registers_;
    void* suspended = &from.registers_;
    static_assert(offsetof(Registers, stack_pointer) == 0 && offsetof(Registers, resume_at) == 24);
    asm volatile(
        "leaq 1f(%%rip), %%rax\n\t"
        "movq %%rsp, (%%rdi)\n\t"
        "movq %%rbp, 8(%%rdi)\n\t"
        "movq %%rbx, 16(%%rdi)\n\t"
        "movq %%rax, 24(%%rdi)\n\t"
        "movq (%%rsi), %%rsp\n\t"
        "movq 8(%%rsi), %%rbp\n\t"
        "movq 16(%%rsi), %%rbx\n\t"
        "jmpq *24(%%rsi)\n\t"
        "1:"
        : "+D"(suspended), "+S"(resumed)
        :
        : "rax", "rcx", "rdx", "r8", "r9", "r10", "r11", "r12", "r13", "r14", "r15", "xmm0", "xmm1", "xmm2",
          "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14",
          "xmm15", "cc", "memory");
  }

  /// While suspended.
  [[nodiscard]] void* stack_pointer() const noexcept { return registers_.stack_pointer; }
  /// While suspended: what is kept of the registers, the stack pointer included.
  [[nodiscard]] std::span<const std::byte> registers() const noexcept {
    return std::as_bytes(std::span{&registers_, 1});
  }

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

  /// While suspended; at the begin of a context, where switch_between() finds them.
  struct Registers {
    void* stack_pointer = nullptr;
    void* frame_pointer = nullptr;
    void* base = nullptr;
    void* resume_at = nullptr;
  };

  static void begin() noexcept;
  static void set_thread_pointer(void* value) noexcept {
    if (fs_base_is_writable_) [[likely]] {
      asm volatile("wrfsbase %0" : : "r"(value) : "memory");
    } else {
      set_thread_pointer_by_system_call(value);
    }
  }
  static void set_thread_pointer_by_system_call(void* value) noexcept;
  static void exchange_float_control(Context& from, Context& to) noexcept;

  static inline bool float_control_matters_ = false;
  static const bool fs_base_is_writable_;

  Registers registers_;
  void* thread_pointer_ = nullptr;
  // While suspended, if they are exchanged:
  std::uint32_t mxcsr_ = mxcsr_at_begin;  // SSE control and status
  X87Environment x87_;
};

}  // namespace ltsim
