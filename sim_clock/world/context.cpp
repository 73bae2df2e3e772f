#include "sim_clock/world/context.hpp"

#include <asm/prctl.h>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xmmintrin.h>

#include "sim_clock/world/thread_pointer.hpp"

namespace ltsim {
namespace {

#ifndef HWCAP2_FSGSBASE
constexpr unsigned long HWCAP2_FSGSBASE = 1U << 1U;  // Linux, arch/x86/include/uapi/asm/hwcap2.h
#endif

/// Whether user code may write the FS base itself. Without it (Linux before 5.9) each switch is a system
/// call.
const bool fs_base_is_writable = (getauxval(AT_HWCAP2) & HWCAP2_FSGSBASE) != 0;

inline void set_thread_pointer(void* value) noexcept {
  if (fs_base_is_writable) [[likely]] {
    asm volatile("wrfsbase %0" : : "r"(value) : "memory");
  } else {
    // A raw system call: syscall(2) would write errno, which lies in the storage that is being exchanged.
    long result = SYS_arch_prctl;
    asm volatile("syscall"
                 : "+a"(result)
                 : "D"(static_cast<long>(ARCH_SET_FS)), "S"(value)
                 : "rcx", "r11", "memory");
  }
}

constexpr std::uint32_t mxcsr_status = 0x3f;  // its sticky exception flags

bool float_control_matters = false;

}  // namespace

void Context::prepare(void* stack_top, void* thread_pointer, void (*entry)(void*), void* argument) noexcept {
  // As exchange_stacks() leaves the stack of a suspended context; begin() finds `entry` and `argument` in two of
  // the registers. Behind its own address there is none: here a stack trace ends.
  void** at = static_cast<void**>(stack_top);
  *--at = nullptr;
  *--at = reinterpret_cast<void*>(&Context::begin);
  *--at = nullptr;                         // rbp
  *--at = argument;                        // rbx
  *--at = reinterpret_cast<void*>(entry);  // r12
  for (int i = 13; i <= 15; ++i) *--at = nullptr;
  stack_pointer_ = at;
  thread_pointer_ = thread_pointer;
  if (!float_control_matters) return;
  mxcsr_ = _mm_getcsr() & ~mxcsr_status;
  asm volatile("fnstenv %0\n\tfldenv %0" : "+m"(x87_));  // fnstenv itself masks exceptions
  x87_.status = 0;
}

void Context::adopt_current() noexcept { thread_pointer_ = current_thread_pointer(); }

void Context::exchange_float_control_from_now_on() noexcept { float_control_matters = true; }

// Not inlined: no address of a thread-local may be kept across the change of the FS base.
[[gnu::noinline]] void Context::switch_between(Context& from, Context& to) noexcept {
  if (float_control_matters) [[unlikely]]
    exchange_float_control(from, to);
  set_thread_pointer(to.thread_pointer_);
  exchange_stacks(&from.stack_pointer_, to.stack_pointer_);
}

[[gnu::noinline]] void Context::exchange_float_control(Context& from, Context& to) noexcept {
  from.mxcsr_ = _mm_getcsr();
  _mm_setcsr(to.mxcsr_);
  asm volatile("fnstenv %0\n\tfldenv %1" : "=m"(from.x87_) : "m"(to.x87_));
}

[[gnu::naked, gnu::noinline]] void Context::exchange_stacks(void** /*suspended*/,
                                                            void* /*resumed*/) noexcept {
  asm("pushq %rbp\n\t"
      "pushq %rbx\n\t"
      "pushq %r12\n\t"
      "pushq %r13\n\t"
      "pushq %r14\n\t"
      "pushq %r15\n\t"
      "movq %rsp, (%rdi)\n\t"
      "movq %rsi, %rsp\n\t"
      "popq %r15\n\t"
      "popq %r14\n\t"
      "popq %r13\n\t"
      "popq %r12\n\t"
      "popq %rbx\n\t"
      "popq %rbp\n\t"
      // Not `ret`: the processor would expect the caller on the old stack. The address is nearly always the same.
      "popq %rax\n\t"
      "jmpq *%rax");
}

[[gnu::naked]] void Context::begin() noexcept {
  asm("movq %rbx, %rdi\n\t"
      "jmpq *%r12");
}

}  // namespace ltsim
