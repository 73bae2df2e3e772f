// What a whole program writes on its standard output and for errors, kept apart from what the simulator prints.
//
// Both descriptors lead to a file in memory while it runs; the simulator's own are put back after that.
#pragma once

#include <string>

namespace ltsim {

class OutputCapture {
 public:
  /// More is not kept.
  static constexpr std::size_t bytes_max = std::size_t{1} << 20U;

  OutputCapture();
  ~OutputCapture();
  OutputCapture(const OutputCapture&) = delete;
  OutputCapture& operator=(const OutputCapture&) = delete;

  /// From here on, up to end(), what is written to descriptors 1 and 2 is kept. What was kept is forgotten.
  void begin();
  /// @return what was written, the first bytes_max of it
  std::string end();

 private:
  int file_ = -1;
  int out_ = -1;  // the simulator's own
  int error_ = -1;
};

}  // namespace ltsim
