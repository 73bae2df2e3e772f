#include "sim_clock/explore/forked_work.hpp"

#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

namespace ltsim {

void ForkedWork::die_of(int status) noexcept {
  if (WIFEXITED(status)) _exit(WEXITSTATUS(status));
  ::signal(WTERMSIG(status), SIG_DFL);
  raise(WTERMSIG(status));
  _exit(1);  // a signal that is blocked
}

/// The child begins on this processor, whose caches hold what it needs and which has nothing to do but wait for it; where it goes then is
/// the system's affair. @return as of fork(2)
pid_t ForkedWork::fork_beside() noexcept {
  cpu_set_t all;
  cpu_set_t here;
  CPU_ZERO(&here);
  const int processor = sched_getcpu();
  const bool knows = processor >= 0 && processor < CPU_SETSIZE && sched_getaffinity(0, sizeof all, &all) == 0;
  if (knows) {
    CPU_SET(processor, &here);
    sched_setaffinity(0, sizeof here, &here);
  }
  // Without what a library, or the code under test, has registered for its own forks: this is none of those.
  const pid_t id = _Fork();
  if (knows) sched_setaffinity(0, sizeof all, &all);
  return id;
}

void ForkedWork::run_apart(const std::function<void()>& work) {
  std::fflush(stdout);  // or the child would print it again
  const pid_t parent = getpid();
  processes_count_ = processes_count_ + 1;
  const pid_t id = fork_beside();
  if (id < 0) throw std::system_error{errno, std::generic_category(), "process of an execution"};
  if (id == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);  // it died before that
    work();
    _exit(0);
  }
  process_ = id;
  int status = 0;
  while (waitpid(id, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
  if (status != 0) die_of(status);
}

}  // namespace ltsim
