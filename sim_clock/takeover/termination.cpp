// How a task ends badly: abort(3), a failed assert(3), exit(3). libc's stdio buffers are flushed by nobody,
// as with the real calls.

#include <unistd.h>

#include <cstdlib>
#include <exception>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

[[noreturn]] void fail(ltsim::OutcomeKind kind, const std::string& message) {
  ltsim::Task& self = *current_task;
  const ltsim::GhostScope ghost;
  self.world->scheduler().fail(kind, fmt::format("{}: {}", self.name, message));
  LTSIM_UNREACHABLE("a failed task went on");
}

/// The exception that nobody caught, if that is why std::terminate() came here.
std::string exception_in_flight() {
  try {
    if (std::current_exception() == nullptr) return {};
    throw;
  } catch (const std::exception& exception) {
    return exception.what();
  } catch (...) {
    return "of an unknown type";
  }
}

}  // namespace

extern "C" void abort() noexcept {
  if (current_task == nullptr) {
    LTSIM_NEXT(abort)();
  } else if (const std::string exception = exception_in_flight(); !exception.empty()) {
    fail(ltsim::OutcomeKind::crash, fmt::format("nobody caught the exception \"{}\"", exception));
  } else {
    fail(ltsim::OutcomeKind::assertion, "abort() was called");
  }
  __builtin_unreachable();
}

extern "C" void __assert_fail(const char* expression, const char* file, unsigned line,
                              const char* function) noexcept {
  using Function = void(const char*, const char*, unsigned, const char*);
  static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "__assert_fail"));
  if (current_task == nullptr) {
    next(expression, file, line, function);
  } else {
    fail(ltsim::OutcomeKind::assertion,
         fmt::format("{}:{}: assertion \"{}\" failed", file, line, expression));
  }
  __builtin_unreachable();
}

// exit(3) and its kind would end the simulator and every result with it, unless the world knows what they come to. The last
// argument is the exception specification of libc's declaration.
#define LTSIM_EXIT(name, is_orderly_, specification)                                               \
  extern "C" void name(int status_) specification {                                                \
    if (current_task == nullptr) {                                                                 \
      LTSIM_NEXT(name)(status_);                                                                   \
    } else if (const auto& exit = current_task->world->exit(); exit) {                             \
      exit({.status = status_, .is_orderly = is_orderly_, .stack = __builtin_frame_address(0)});   \
    } else {                                                                                       \
      fail(ltsim::OutcomeKind::unsupported, #name "() was called, which would end the simulator"); \
    }                                                                                              \
    __builtin_unreachable();                                                                       \
  }

LTSIM_EXIT(exit, true, noexcept)
LTSIM_EXIT(_exit, false, )
LTSIM_EXIT(_Exit, false, noexcept)
LTSIM_EXIT(quick_exit, false, noexcept)
