// Calls that would let the host's time, scheduler or other processes into the simulated world and that it
// does not simulate. In a task each ends the execution with outcome "unsupported" and its name; outside they
// are the real ones.

#include <dlfcn.h>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace {

void refuse(const char* name) noexcept {
  ltsim::World& world = *ltsim::current_task->world;
  world.unsupported(
      fmt::format("{} called {}, which ltsim does not simulate", ltsim::current_task->name, name));
}

}  // namespace

// Every function here takes at most six integer or pointer arguments, so the x86-64 calling convention lets
// one shape pass them all on. The assembler name keeps it apart from libc's own declaration.
#define LTSIM_REFUSED(name)                                                                      \
  extern "C" long refused_##name(long, long, long, long, long, long) noexcept asm(#name);        \
  extern "C" long refused_##name(long a, long b, long c, long d, long e, long f) noexcept {      \
    if (ltsim::current_task != nullptr) refuse(#name);                                           \
    static auto* const next =                                                                    \
        reinterpret_cast<long (*)(long, long, long, long, long, long)>(dlsym(RTLD_NEXT, #name)); \
    return next(a, b, c, d, e, f);                                                               \
  }

LTSIM_REFUSED(pthread_kill)
LTSIM_REFUSED(pthread_sigqueue)
LTSIM_REFUSED(pthread_mutex_setprioceiling)
LTSIM_REFUSED(fork)
LTSIM_REFUSED(execve)
LTSIM_REFUSED(execv)
LTSIM_REFUSED(execvp)
LTSIM_REFUSED(execvpe)
LTSIM_REFUSED(execl)
LTSIM_REFUSED(execlp)
LTSIM_REFUSED(execle)
LTSIM_REFUSED(fexecve)
LTSIM_REFUSED(posix_spawnp)
LTSIM_REFUSED(popen)
LTSIM_REFUSED(waitid)
LTSIM_REFUSED(wait3)
LTSIM_REFUSED(wait4)
LTSIM_REFUSED(killpg)
LTSIM_REFUSED(tgkill)
LTSIM_REFUSED(raise)
LTSIM_REFUSED(pipe2)
LTSIM_REFUSED(posix_spawn)
LTSIM_REFUSED(system)
LTSIM_REFUSED(wait)
LTSIM_REFUSED(waitpid)
LTSIM_REFUSED(alarm)
LTSIM_REFUSED(setitimer)
LTSIM_REFUSED(timer_create)
LTSIM_REFUSED(timerfd_create)
LTSIM_REFUSED(pause)
LTSIM_REFUSED(sigsuspend)
LTSIM_REFUSED(poll)
LTSIM_REFUSED(ppoll)
LTSIM_REFUSED(select)
LTSIM_REFUSED(pselect)
LTSIM_REFUSED(epoll_wait)
LTSIM_REFUSED(epoll_pwait)
LTSIM_REFUSED(eventfd)
LTSIM_REFUSED(pipe)
LTSIM_REFUSED(socket)
LTSIM_REFUSED(socketpair)
LTSIM_REFUSED(accept)
LTSIM_REFUSED(connect)
LTSIM_REFUSED(recv)
LTSIM_REFUSED(send)
LTSIM_REFUSED(msgget)
LTSIM_REFUSED(mq_open)
LTSIM_REFUSED(flock)
LTSIM_REFUSED(lockf)
LTSIM_REFUSED(mremap)
LTSIM_REFUSED(clock_settime)
LTSIM_REFUSED(settimeofday)
LTSIM_REFUSED(getloadavg)
