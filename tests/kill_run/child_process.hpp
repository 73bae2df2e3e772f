// A process that was forked to run one function, and that nobody leaves behind.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>

namespace kill_run {

/// How a process ended.
struct Ending {
  bool by_signal = false;
  int code = 0;  ///< the signal, or the exit code

  bool operator==(const Ending&) const = default;
};

class ChildProcess {
 public:
  /// Forks. The child ignores SIGINT, which its parent answers, and is killed when its parent dies.
  /// @param body  its exit code
  /// @throw std::system_error  there is no room for another process
  explicit ChildProcess(const std::function<int()>& body);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills it if it is still there.
  ~ChildProcess();

  /// Of one that has not been waited for. Also when it has ended meanwhile.
  void send(int signal) noexcept;
  /// @return how it ended, then and from then on; nothing if it still runs after `timeout`
  std::optional<Ending> wait_for(std::chrono::nanoseconds timeout) noexcept;

 private:
  pid_t pid_;
  int handle_;  // readable when it has ended
  std::optional<Ending> ending_;
};

}  // namespace kill_run
