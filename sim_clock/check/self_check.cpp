#include "sim_clock/check/self_check.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "sim_clock/world/task.hpp"

namespace ltsim {

void internal_error(const char* file, int line, const char* what) noexcept {
  const GhostScope ghost;  // the real _exit(2), also from within a task
  std::fprintf(stderr, "ltsim: internal error: %s:%d: %s\n", file, line, what);
  std::fflush(nullptr);
  _exit(3);
}

}  // namespace ltsim
