#include "sim_clock/program/exit_handlers.hpp"

namespace ltsim {

void ExitHandlers::run(ProcessId process) {
  std::vector<Handler>& handlers = handlers_[process];
  while (!handlers.empty()) {
    const Handler last = handlers.back();
    handlers.pop_back();
    last.function(last.argument);
  }
}

}  // namespace ltsim
