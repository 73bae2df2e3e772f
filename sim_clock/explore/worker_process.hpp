// The process of a worker, as its parent sees it: forked, listened to, killed, waited for.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "sim_clock/explore/worker.hpp"
#include "sim_clock/explore/worker_message.hpp"

namespace ltsim {

class WorkerProcess {
 public:
  /// Forks. The child dies with its parent, and leaves SIGINT and SIGTERM, which a terminal sends to both, to
  /// it.
  /// @param order  its pipe is made here
  /// @throw std::system_error
  WorkerProcess(WorkerOrder order, SharedProgress& progress);
  /// Kills it if it still lives.
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Becomes readable when a message arrives or the process has ended.
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }

  /// Does not wait. @return the messages that have arrived
  [[nodiscard]] std::vector<WorkerMessage> receive();
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
  WorkerMessageReader reader_;
};

/// @param status  of wait(2)
/// @return        "died of SIGKILL", "exited with code 0"
[[nodiscard]] std::string describe_end(int status);

}  // namespace ltsim
