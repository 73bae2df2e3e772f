// How far an exploration is, in one line that is written over, for a person who waits at a terminal.
#pragma once

#include <string>
#include <string_view>

#include "sim_clock/explore/worker_pool.hpp"

namespace ltsim {

/// Writes to standard error, and nothing at all where that is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(std::string_view scenario);
  /// Takes the line away.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// At most once a second is anything written.
  void show(const ExploreProgress& progress);

 private:
  std::string scenario_;
  bool is_terminal_;
  bool is_shown_ = false;
  ExploreProgress shown_;
};

}  // namespace ltsim
