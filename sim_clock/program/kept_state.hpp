// The state that a whole program, or the image of a process, had when its main() was called first: what each execution, and each life
// of a process, begins with.
//
// What is put back: variables, heap, what was asked of atexit(3); a task's thread-locals are its own. Not put back is what a library
// keeps for itself (a locale, a stream's state), and files.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sim_clock/world/program_image.hpp"

namespace ltsim {

class KeptState {
 public:
  /// As it is now, of all images.
  KeptState();

  /// Of all images: at the begin of an execution.
  void restore();
  /// Of one image, as the process of the same number begins again.
  void restore_image(std::size_t image);

 private:
  void restore_variables(std::size_t image);

  std::array<std::vector<std::byte>, ProgramImage::images_max> variables_;
};

}  // namespace ltsim
