// The descriptors that a whole program begins with, for each execution in one process.
//
// What an execution has opened and not closed is closed before the next; standard input is there again, and begins where it began. Of
// other descriptors that were there before main(), where they stand and whether they are open is not put back.
#pragma once

#include <sys/types.h>

#include <optional>
#include <vector>

namespace ltsim {

class OpenDescriptors {
 public:
  /// Those that are open now are what each execution begins with.
  OpenDescriptors();
  ~OpenDescriptors();
  OpenDescriptors(const OpenDescriptors&) = delete;
  OpenDescriptors& operator=(const OpenDescriptors&) = delete;

  /// Others than at the begin, of those that a program opens.
  [[nodiscard]] std::vector<int> left_open() const;
  void close_left_open() const noexcept;
  /// Standard input. Where a forked process has read, its parent has as well.
  void rewind_input() const noexcept;

 private:
  [[nodiscard]] static std::vector<int> open_now();

  std::vector<int> kept_;  // in order
  int input_ = -1;         // a copy of standard input; -1: there is none
  off_t input_begin_ = -1;
};

}  // namespace ltsim
