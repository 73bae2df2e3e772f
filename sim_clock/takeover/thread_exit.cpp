// pthread_exit(3), and cancellation, which is refused.
//
// The frames of the task's body are unwound as by glibc: destructors of C++ run, and the handlers of pthread_cleanup_push(3) in C; `catch
// (...)` is entered and has to throw on. Who does not, or is in a function that is noexcept, ends the execution, as the
// program would end. Then the destructors of thread-locals and of keys run, and the task ends, on the stack as it is: there is nothing on it
// that anybody could go back to.

#include <pthread.h>
#include <setjmp.h>
#include <unwind.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

using ltsim::Task;

/// Somebody has caught it for good.
void was_caught(_Unwind_Reason_Code /*why*/, _Unwind_Exception* /*unwinding*/) {
  const Task& self = *current_task;
  const ltsim::GhostScope ghost;
  self.world->scheduler().fail(
      ltsim::OutcomeKind::assertion,
      fmt::format("{}: what pthread_exit() throws was caught by \"catch (...)\", which has to throw it on",
                  self.name));
}

std::uintptr_t number_of(const void* address) noexcept { return reinterpret_cast<std::uintptr_t>(address); }

/// Called for each frame, from the innermost one on, before its destructors run.
_Unwind_Reason_Code stop_at(int /*version*/, _Unwind_Action actions, _Unwind_Exception_Class /*of*/,
                            _Unwind_Exception* unwinding, _Unwind_Context* context, void* /*unused*/) {
  Task& self = *current_task;
  // Where the stack pointer of this frame is: above it are its own words, and those of its callers.
  const std::uintptr_t frame = _Unwind_GetCFA(context);
  const bool is_over = (actions & _UA_END_OF_STACK) != 0 || frame > number_of(self.body_frame);
  if (!self.cleanup_buffers.empty() && (is_over || frame > number_of(self.cleanup_buffers.back()))) {
    auto* const buffer = static_cast<__pthread_unwind_buf_t*>(self.cleanup_buffers.back());
    self.cleanup_buffers.pop_back();
    delete unwinding;  // the handler ends by beginning anew
    longjmp(reinterpret_cast<__jmp_buf_tag*>(buffer->__cancel_jmp_buf), 1);
  }
  if (!is_over) return _URC_NO_REASON;
  delete unwinding;
  ltsim::Scheduler::end_running();
}

[[noreturn]] void unwind_body() {
  auto* const unwinding = new _Unwind_Exception{};
  unwinding->exception_cleanup = &was_caught;
  _Unwind_ForcedUnwind(unwinding, &stop_at, nullptr);
  __builtin_trap();  // a stack without an end
}

[[noreturn]] void exit_task(void* result) {
  Task& self = *current_task;
  if (self.body_frame == nullptr) {
    self.world->unsupported(fmt::format(
        "{} called pthread_exit in a destructor that runs at its end, which ltsim does not simulate",
        self.name));
  }
  self.result = result;
  unwind_body();
}

}  // namespace

extern "C" void pthread_exit(void* result) {
  if (current_task != nullptr) exit_task(result);
  LTSIM_NEXT(pthread_exit)(result);
  __builtin_unreachable();
}

// What pthread_cleanup_push(3) makes of itself in C.

extern "C" void __pthread_register_cancel(__pthread_unwind_buf_t* buffer) noexcept {
  if (current_task == nullptr) {
    using Function = void(__pthread_unwind_buf_t*);
    static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "__pthread_register_cancel"));
    return next(buffer);
  }
  current_task->cleanup_buffers.push_back(buffer);
}

extern "C" void __pthread_unregister_cancel(__pthread_unwind_buf_t* buffer) noexcept {
  if (current_task == nullptr) {
    using Function = void(__pthread_unwind_buf_t*);
    static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "__pthread_unregister_cancel"));
    return next(buffer);
  }
  if (!current_task->cleanup_buffers.empty()) current_task->cleanup_buffers.pop_back();
}

extern "C" void __pthread_unwind_next(__pthread_unwind_buf_t* buffer) {
  if (current_task != nullptr) unwind_body();
  using Function = void(__pthread_unwind_buf_t*);
  static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "__pthread_unwind_next"));
  next(buffer);
  __builtin_unreachable();
}

// Cancellation: nobody is cancelled, so the rest of it has nothing to do.

extern "C" int pthread_cancel(pthread_t thread) {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_cancel)(thread);
  current_task->world->unsupported(fmt::format(
      "{} called pthread_cancel, which ltsim does not simulate: let the thread look at a flag, and return",
      current_task->name));
  return ENOSYS;
}

extern "C" int pthread_setcancelstate(int state, int* old_state) {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_setcancelstate)(state, old_state);
  if (state != PTHREAD_CANCEL_ENABLE && state != PTHREAD_CANCEL_DISABLE) return EINVAL;
  if (old_state != nullptr) *old_state = current_task->traits.cancel_state;
  current_task->traits.cancel_state = state;
  return 0;
}

extern "C" int pthread_setcanceltype(int type, int* old_type) {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_setcanceltype)(type, old_type);
  if (type != PTHREAD_CANCEL_DEFERRED && type != PTHREAD_CANCEL_ASYNCHRONOUS) return EINVAL;
  if (old_type != nullptr) *old_type = current_task->traits.cancel_type;
  current_task->traits.cancel_type = type;
  return 0;
}

extern "C" void pthread_testcancel() {
  if (current_task == nullptr) LTSIM_NEXT(pthread_testcancel)();
}
