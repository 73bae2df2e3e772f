// What a process of whole programs has asked to be called when it exits: atexit(3), destructors of static objects. Each life of it
// exits once.
#pragma once

#include <array>
#include <vector>

#include "sim_clock/world/task.hpp"

namespace ltsim {

class ExitHandlers {
 public:
  struct Handler {
    void (*function)(void*);
    void* argument;
  };

  static void add(ProcessId process, Handler handler) { handlers_[process].push_back(handler); }
  /// What was added up to now was so before main(), and is there in each execution.
  static void keep_for_each_execution() { kept_ = handlers_; }
  static void restore(ProcessId process) { handlers_[process] = kept_[process]; }
  /// Calls them, the last one that was added first; what is added meanwhile, too.
  static void run(ProcessId process);

 private:
  static inline std::array<std::vector<Handler>, processes_max> handlers_;
  static inline std::array<std::vector<Handler>, processes_max> kept_;
};

}  // namespace ltsim
