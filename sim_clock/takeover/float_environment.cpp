// <cfenv>. Rounding, masks and exception flags belong to a thread. The functions work on the processor's registers, so the
// real ones are right in a task, too: the world has only to exchange the registers at each switch from now on.
//
// Code that sets the registers itself, by _mm_setcsr() or inline assembly, is not noticed: its tasks share them.

#include <cfenv>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/task.hpp"

namespace {

void note_use() noexcept {
  if (ltsim::current_task != nullptr) ltsim::Context::exchange_float_control_from_now_on();
}

}  // namespace

#define LTSIM_FLOAT_ENVIRONMENT(name, parameters, arguments) \
  extern "C" int name parameters noexcept {                  \
    note_use();                                              \
    return LTSIM_NEXT(name) arguments;                       \
  }

LTSIM_FLOAT_ENVIRONMENT(fesetround, (int rounding), (rounding))
LTSIM_FLOAT_ENVIRONMENT(feclearexcept, (int exceptions), (exceptions))
LTSIM_FLOAT_ENVIRONMENT(feraiseexcept, (int exceptions), (exceptions))
LTSIM_FLOAT_ENVIRONMENT(fetestexcept, (int exceptions), (exceptions))
LTSIM_FLOAT_ENVIRONMENT(feenableexcept, (int exceptions), (exceptions))
LTSIM_FLOAT_ENVIRONMENT(fedisableexcept, (int exceptions), (exceptions))
LTSIM_FLOAT_ENVIRONMENT(fesetenv, (const fenv_t* environment), (environment))
LTSIM_FLOAT_ENVIRONMENT(fegetenv, (fenv_t * into), (into))
LTSIM_FLOAT_ENVIRONMENT(feupdateenv, (const fenv_t* environment), (environment))
LTSIM_FLOAT_ENVIRONMENT(feholdexcept, (fenv_t * into), (into))
LTSIM_FLOAT_ENVIRONMENT(fegetexceptflag, (fexcept_t * into, int exceptions), (into, exceptions))
LTSIM_FLOAT_ENVIRONMENT(fesetexceptflag, (const fexcept_t* flags, int exceptions), (flags, exceptions))
