// How far something is, in one line that is written over, for a person who waits at a terminal.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>

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
  /// @param elapsed  since the begin
  /// @param text     asked for if it is written; comes after the name of the scenario
  void show(std::chrono::duration<double> elapsed, const std::function<std::string()>& text);

 private:
  std::string scenario_;
  bool is_terminal_;
  bool is_shown_ = false;
  std::chrono::duration<double> shown_at_{0};
};

}  // namespace ltsim
