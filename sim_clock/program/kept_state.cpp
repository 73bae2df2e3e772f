#include "sim_clock/program/kept_state.hpp"

#include <sys/single_threaded.h>

#include <cstring>

#include "sim_clock/program/exit_handlers.hpp"
#include "sim_clock/world/program_heap.hpp"

namespace ltsim {

KeptState::KeptState() {
  __libc_single_threaded = 0;  // a variable of the program, if its code looks at it: see World
  for (std::size_t i = 0; i < ProgramImage::count(); ++i) {
    const auto variables = ProgramImage::variables(i);
    variables_[i].assign(variables.begin(), variables.end());
  }
  ProgramHeap::keep_for_each_execution();
  ExitHandlers::keep_for_each_execution();
}

void KeptState::restore() {
  ProgramHeap::restore();
  for (std::size_t i = 0; i < ProgramImage::count(); ++i) {
    restore_variables(i);
    ExitHandlers::restore(static_cast<ProcessId>(i));
  }
}

void KeptState::restore_image(std::size_t image) {
  ProgramHeap::restore_image(image);
  restore_variables(image);
  ExitHandlers::restore(static_cast<ProcessId>(image));
}

void KeptState::restore_variables(std::size_t image) {
  std::memcpy(ProgramImage::variables(image).data(), variables_[image].data(), variables_[image].size());
}

}  // namespace ltsim
