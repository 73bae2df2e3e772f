// Descriptors of real files that tasks have opened: a process that dies closes its own, and what an execution leaves open is not
// there in the next.
#pragma once

#include <functional>
#include <vector>

#include "sim_clock/world/task.hpp"

namespace ltsim {

class Descriptors {
 public:
  /// @param closes  what the last execution has left open; otherwise it is somebody else's to close
  void reset(bool closes) {
    if (closes && !open_.empty()) close_if([](ProcessId) { return true; });
    open_.clear();
  }
  void process_died(ProcessId process) {
    if (!open_.empty()) close_if([=](ProcessId owner) { return owner == process; });
  }

  /// The running task has opened it.
  /// @param descriptor  -1: it has not
  /// @return            the descriptor
  int opened(int descriptor);
  /// It was closed.
  void closed(int descriptor);

 private:
  struct Open {
    int descriptor;
    ProcessId owner;
  };

  void close_if(const std::function<bool(ProcessId owner)>& is_meant);

  std::vector<Open> open_;
};

}  // namespace ltsim
