#include "tests/kill_run/child_process.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

namespace kill_run {

namespace {

[[noreturn]] void run_as_child(const std::function<int()>& body, pid_t parent) {
  ::signal(SIGINT, SIG_IGN);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // It may have died before that.
  if (::getppid() != parent) ::_exit(0);
  ::_exit(body());
}

}  // namespace

ChildProcess::ChildProcess(const std::function<int()>& body) {
  std::fflush(nullptr);  // or the child would print it once more
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) run_as_child(body, parent);
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "fork");
  // glibc 2.36 has a function for it, older ones have not.
  handle_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
  if (handle_ >= 0) return;
  const int error = errno;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  throw std::system_error(error, std::generic_category(), "pidfd_open");
}

ChildProcess::~ChildProcess() {
  if (!ending_) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ::close(handle_);
}

void ChildProcess::send(int signal) noexcept { ::kill(pid_, signal); }

std::optional<Ending> ChildProcess::wait_for(std::chrono::nanoseconds timeout) noexcept {
  if (ending_) return ending_;
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + timeout;
  pollfd ended{.fd = handle_, .events = POLLIN, .revents = 0};
  for (;;) {
    const auto left = std::max<std::chrono::nanoseconds>(deadline - Clock::now(), {});
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec limit{.tv_sec = static_cast<std::time_t>(seconds.count()),
                         .tv_nsec = static_cast<long>((left - seconds).count())};
    const int found = ::ppoll(&ended, 1, &limit, nullptr);
    if (found > 0) break;
    if (found == 0) return std::nullopt;  // otherwise a signal has ended the wait
  }
  int status = 0;
  ::waitpid(pid_, &status, 0);
  ending_ = WIFSIGNALED(status) ? Ending{.by_signal = true, .code = WTERMSIG(status)}
                                : Ending{.by_signal = false, .code = WEXITSTATUS(status)};
  return ending_;
}

}  // namespace kill_run
