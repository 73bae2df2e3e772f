#include "sim_clock/program/exit_handlers.hpp"

namespace ltsim {

void ExitHandlers::run() {
  while (!handlers_.empty()) {
    const Handler last = handlers_.back();
    handlers_.pop_back();
    last.function(last.argument);
  }
}

}  // namespace ltsim
