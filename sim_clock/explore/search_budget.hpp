// What a search may use up: executions, scheduling points, real time; whichever ends first.
//
// Points make an end that is the same on each machine, real time one that a person can wait for.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>

namespace ltsim {

class SearchBudget {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

  SearchBudget(std::uint64_t executions_max, std::uint64_t points_max,
               std::chrono::duration<double> seconds_max)
      : executions_max_(executions_max),
        points_max_(points_max),
        begin_(Clock::now()),
        seconds_max_(seconds_max) {}

  void use(std::uint64_t points) noexcept {
    ++executions_;
    points_ += points;
  }

  /// Used up so far, the largest of the three parts: 0 to 1 and, by the last execution, a little more.
  [[nodiscard]] double used() const noexcept {
    const auto part = [](std::uint64_t used, std::uint64_t maximum) {
      return maximum == unlimited ? 0.0
             : maximum == 0       ? 1.0
                                  : static_cast<double>(used) / static_cast<double>(maximum);
    };
    const std::chrono::duration<double> elapsed = Clock::now() - begin_;
    const double time = seconds_max_.count() <= 0 ? 1.0 : elapsed / seconds_max_;
    return std::max({part(executions_, executions_max_), part(points_, points_max_), time});
  }

  [[nodiscard]] std::uint64_t executions() const noexcept { return executions_; }

 private:
  std::uint64_t executions_max_;
  std::uint64_t points_max_;
  Clock::time_point begin_;
  std::chrono::duration<double> seconds_max_;
  std::uint64_t executions_ = 0;
  std::uint64_t points_ = 0;
};

}  // namespace ltsim
