// A process that works for the one that has forked it, as that one sees it: forked, listened to, killed, waited for.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace ltsim {

class WorkerProcess {
 public:
  /// Forks. The child dies with its parent, and leaves SIGINT and SIGTERM, which a terminal sends to both, to
  /// it.
  /// @param work  runs in the child, with its end of a socket to the parent; the child ends with it
  /// @throw std::system_error
  explicit WorkerProcess(const std::function<void(int socket)>& work);
  /// Kills it if it still lives.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// The parent's end of the socket; writing to it waits, reading does not. Becomes readable when something arrives or the process
  /// has ended.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

  /// Does not wait. @return what has arrived
  [[nodiscard]] std::vector<std::uint8_t> receive();
  /// Whether the process has ended, and receive() has returned all that it sent.
  [[nodiscard]] bool has_ended() const noexcept { return has_ended_; }

  void signal(int signal) const noexcept;

  /// Waits until the process has ended.
  /// @return as wait(2) has it
  int wait() noexcept;

 private:
  pid_t id_ = -1;  // -1: waited for
  int descriptor_ = -1;
  bool has_ended_ = false;
};

/// @param status  of wait(2)
/// @return        "died of SIGKILL", "exited with code 0"
[[nodiscard]] std::string describe_end(int status);

}  // namespace ltsim
