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

void ProgressLine::show(const ExploreProgress& progress) {
  const auto since = progress.elapsed - shown_.elapsed;
  if (!is_terminal_ || since < std::chrono::seconds{1}) return;
  const double executions = static_cast<double>(progress.executions - shown_.executions);
  std::fputs(fmt::format("\r\x1b[K{}  {} executions, {:.0f} per second, {} failures", scenario_,
                         progress.executions, executions / since.count(), progress.failures)
                 .c_str(),
             stderr);
  std::fflush(stderr);
  is_shown_ = true;
  shown_ = progress;
}

}  // namespace ltsim
