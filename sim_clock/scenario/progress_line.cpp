#include "sim_clock/scenario/progress_line.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace ltsim {

ProgressLine::ProgressLine(std::string_view scenario)
    : scenario_(scenario), is_terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() {
  if (is_shown_) std::fputs("\r\x1b[K", stderr);
}

void ProgressLine::show(std::chrono::duration<double> elapsed, const std::function<std::string()>& text) {
  if (!is_terminal_ || elapsed - shown_at_ < std::chrono::seconds{1}) return;
  std::fputs(fmt::format("\r\x1b[K{}  {}", scenario_, text()).c_str(), stderr);
  std::fflush(stderr);
  is_shown_ = true;
  shown_at_ = elapsed;
}

}  // namespace ltsim
