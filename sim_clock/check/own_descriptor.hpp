// Descriptors of the simulator's own: they lie above those that a program opens, so that it gets the numbers that it gets without us.
#pragma once

#include <fcntl.h>
#include <unistd.h>

namespace ltsim {

inline constexpr int own_descriptors_begin = 512;

/// @param descriptor  is closed; -1: there is none
/// @return            the same file; -1 if there is none
[[nodiscard]] inline int as_own_descriptor(int descriptor) noexcept {
  if (descriptor < 0) return descriptor;
  const int own = fcntl(descriptor, F_DUPFD_CLOEXEC, own_descriptors_begin);
  close(descriptor);
  return own;
}

}  // namespace ltsim
