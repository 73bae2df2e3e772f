#include "sim_clock/world/context.hpp"

#include <asm/prctl.h>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "sim_clock/check/self_check.hpp"
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

}  // namespace

void Context::prepare(void* stack_top, std::size_t stack_bytes, void* thread_pointer, void (*entry)(void*),
                      void* argument) noexcept {
  resume_point_ = boost::context::detail::make_fcontext(stack_top, stack_bytes, &Context::enter);
  thread_pointer_ = thread_pointer;
  entry_ = entry;
  argument_ = argument;
}

void Context::adopt_current() noexcept { thread_pointer_ = current_thread_pointer(); }

// Not inlined: no address of a thread-local may be kept across the change of the FS base.
[[gnu::noinline]] void Context::switch_between(Context& from, Context& to) noexcept {
  Context* const parties[2] = {&from, &to};
  set_thread_pointer(to.thread_pointer_);
  const auto back = boost::context::detail::jump_fcontext(to.resume_point_, const_cast<Context**>(parties));
  static_cast<Context**>(back.data)[0]->resume_point_ = back.fctx;
}

void Context::enter(boost::context::detail::transfer_t transfer) noexcept {
  auto* const parties = static_cast<Context**>(transfer.data);
  parties[0]->resume_point_ = transfer.fctx;
  const Context& self = *parties[1];
  self.entry_(self.argument_);
  LTSIM_UNREACHABLE("a task returned from its entry function");
}

}  // namespace ltsim
