// The record of a run for people: when each M, S and T function was given to the PLC, when its FIN came, how long the
// PLC took and how it ended; and how long the axes moved.
//
//   block      function                begin s     FIN s  duration s  result
//   N30        M6 T1                      0.06      4.31        4.25  done
//   N60        M8                         6.80         -        3.02  alarm 6
//   motion: 5 rapids 1.20 s, 3 feed moves 12.40 s, 1 dwell 0.50 s
//
// Times are seconds since the program start: from "program running" on.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/logic_task.hpp"
#include "kernel_mocks/motion.hpp"

namespace kernel_mocks {

class FunctionTable {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  void program_begun(TimePoint at) { program_begun_ = at; }
  /// The strobes are up; the function before has been told of.
  void given(const Block& block, const FunctionRequest& request, TimePoint at);
  /// @param duration  from the strobes to FIN
  void acknowledged(std::chrono::nanoseconds duration);
  /// @param at  when the kernel gave up
  void not_acknowledged(const LogicFailure& failure, TimePoint at);
  /// @param reached  whether the motion came to its end
  void moved(MotionKind kind, std::chrono::nanoseconds duration, bool reached);

  /// Lines, each with its line feed; a table without a function has its head alone.
  [[nodiscard]] std::string to_text() const;

 private:
  struct Row {
    std::string block;
    std::string function;
    TimePoint begin;
    std::optional<TimePoint> fin;
    std::chrono::nanoseconds duration{0};
    std::string result;
  };
  struct Motions {
    unsigned count = 0;
    std::chrono::nanoseconds duration{0};
  };

  TimePoint program_begun_;
  std::vector<Row> rows_;
  std::array<Motions, motion_kind_count> motions_{};
  bool cut_short_ = false;
};

}  // namespace kernel_mocks
