#include "sim_clock/explore/worker_process.hpp"

#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "sim_clock/check/own_descriptor.hpp"

namespace ltsim {
namespace {

[[noreturn]] void throw_errno(const char* what) {
  throw std::system_error{errno, std::generic_category(), what};
}

}  // namespace

WorkerProcess::WorkerProcess(const std::function<void(int)>& work) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) throw_errno("socket of a worker");
  for (int& end : ends) end = as_own_descriptor(end);
  std::fflush(nullptr);  // or the child would print it again
  const pid_t parent = getpid();
  const pid_t id = fork();
  if (id < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    throw std::system_error{error, std::generic_category(), "worker process"};
  }
  if (id == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);  // it died before that
    ::signal(SIGINT, SIG_IGN);
    ::signal(SIGTERM, SIG_IGN);
    close(ends[0]);
    work(ends[1]);
    std::fflush(nullptr);  // what a scenario printed
    _exit(0);
  }
  id_ = id;
  descriptor_ = ends[0];
  close(ends[1]);  // the only one that is left is the child's: it closes with it
}

WorkerProcess::~WorkerProcess() {
  if (id_ != -1) {
    signal(SIGKILL);
    wait();
  }
  close(descriptor_);
}

std::vector<std::uint8_t> WorkerProcess::receive() {
  std::array<std::uint8_t, 16 * 1024> part{};
  std::vector<std::uint8_t> all;
  for (;;) {
    const ssize_t count = recv(descriptor_, part.data(), part.size(), MSG_DONTWAIT);
    if (count > 0) {
      all.insert(all.end(), part.begin(), part.begin() + count);
    } else if (count == 0 || errno == ECONNRESET) {
      has_ended_ = true;  // reset: it had not read all that was sent to it
      break;
    } else if (errno != EINTR) {
      break;  // nothing more has arrived
    }
  }
  return all;
}

void WorkerProcess::signal(int signal) const noexcept {
  if (id_ != -1) kill(id_, signal);
}

int WorkerProcess::wait() noexcept {
  int status = 0;
  while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  id_ = -1;
  return status;
}

std::string describe_end(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("exited with code {}", WEXITSTATUS(status));
  const char* const name = sigabbrev_np(WTERMSIG(status));
  return name == nullptr ? fmt::format("died of signal {}", WTERMSIG(status))
                         : fmt::format("died of SIG{}", name);
}

}  // namespace ltsim
