#include "sim_clock/check/self_check.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace ltsim {

void internal_error(const char* file, int line, const char* what) noexcept {
  std::fprintf(stderr, "ltsim: internal error: %s:%d: %s\n", file, line, what);
  std::fflush(nullptr);
  _exit(3);
}

}  // namespace ltsim
