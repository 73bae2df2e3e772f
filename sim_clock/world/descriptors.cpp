#include "sim_clock/world/descriptors.hpp"

#include <unistd.h>

namespace ltsim {

void Descriptors::close_if(const std::function<bool(ProcessId owner)>& is_meant) {
  const GhostScope ghost;
  std::erase_if(open_, [&](const Open& open) {
    if (!is_meant(open.owner)) return false;
    close(open.descriptor);
    return true;
  });
}

int Descriptors::opened(int descriptor) {
  if (descriptor < 0) return descriptor;
  const ProcessId owner = current_task->process;
  const GhostScope ghost;
  open_.push_back({descriptor, owner});
  return descriptor;
}

void Descriptors::closed(int descriptor) {
  const GhostScope ghost;
  std::erase_if(open_, [=](const Open& open) { return open.descriptor == descriptor; });
}

}  // namespace ltsim
