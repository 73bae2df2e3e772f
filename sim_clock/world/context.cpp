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

constexpr std::uint32_t mxcsr_status = 0x3f;  // its sticky exception flags

}  // namespace

/// Whether user code may write the FS base itself. Without it (Linux before 5.9) each switch is a system
/// call.
const bool Context::fs_base_is_writable_ = (getauxval(AT_HWCAP2) & HWCAP2_FSGSBASE) != 0;

void Context::set_thread_pointer_by_system_call(void* value) noexcept {
  // A raw system call: syscall(2) would write errno, which lies in the storage that is being exchanged.
  long result = SYS_arch_prctl;
  asm volatile("syscall"
               : "+a"(result)
               : "D"(static_cast<long>(ARCH_SET_FS)), "S"(value)
               : "rcx", "r11", "memory");
}

void Context::prepare(void* stack_top, void* thread_pointer, void (*entry)(void*), void* argument) noexcept {
  // begin() finds `argument` in a register and `entry` on the stack. Behind that, where the address of a caller would be, there
  // is none: here a stack trace ends.
  void** const top = static_cast<void**>(stack_top);
  top[-1] = nullptr;
  top[-2] = reinterpret_cast<void*>(entry);
  registers_ = {.stack_pointer = top - 2,
                .frame_pointer = nullptr,
                .base = argument,
                .resume_at = reinterpret_cast<void*>(&Context::begin)};
  thread_pointer_ = thread_pointer;
  if (!float_control_matters_) return;
  mxcsr_ = _mm_getcsr() & ~mxcsr_status;
  asm volatile("fnstenv %0\n\tfldenv %0" : "+m"(x87_));  // fnstenv itself masks exceptions
  x87_.status = 0;
}

void Context::adopt_current() noexcept { thread_pointer_ = current_thread_pointer(); }

void Context::exchange_float_control_from_now_on() noexcept { float_control_matters_ = true; }

[[gnu::noinline]] void Context::exchange_float_control(Context& from, Context& to) noexcept {
  from.mxcsr_ = _mm_getcsr();
  _mm_setcsr(to.mxcsr_);
  asm volatile("fnstenv %0\n\tfldenv %1" : "=m"(from.x87_) : "m"(to.x87_));
}

[[gnu::naked]] void Context::begin() noexcept {
  asm("movq %rbx, %rdi\n\t"
      "popq %rax\n\t"
      "jmpq *%rax");
}

}  // namespace ltsim
