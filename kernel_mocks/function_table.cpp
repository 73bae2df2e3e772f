#include "kernel_mocks/function_table.hpp"

#include <string_view>

#include <fmt/format.h>

#include "protocol/check.hpp"

namespace kernel_mocks {
namespace {

constexpr std::array<std::string_view, motion_kind_count> names_of_one{"rapid", "feed move", "dwell"};

double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

std::string result_of(const LogicFailure& failure) {
  switch (failure.fault) {
    case LogicFault::alarm:
      return fmt::format("alarm {}", failure.alarm_number);
    case LogicFault::emergency_stop:
    case LogicFault::operator_emergency_stop:
      return "emergency stop";
    case LogicFault::fin_missing:
      return "no FIN";
    case LogicFault::fin_stuck:
      return "FIN stays on";
    case LogicFault::link_lost:
      return "link lost";
    case LogicFault::not_ready:
    case LogicFault::interrupted:
    case LogicFault::spindle_not_at_speed:
    case LogicFault::operator_reset:
    case LogicFault::operator_abort:
      break;
  }
  return "abandoned";
}

}  // namespace

void FunctionTable::given(const Block& block, const FunctionRequest& request, TimePoint at) {
  rows_.push_back({name_of(block), to_string(request), at, {}, {}, "under way"});
}

void FunctionTable::acknowledged(std::chrono::nanoseconds duration) {
  PLC_CHECK(!rows_.empty());
  Row& row = rows_.back();
  row.fin = row.begin + duration;
  row.duration = duration;
  row.result = "done";
}

void FunctionTable::not_acknowledged(const LogicFailure& failure, TimePoint at) {
  PLC_CHECK(!rows_.empty());
  Row& row = rows_.back();
  row.duration = at - row.begin;
  row.result = result_of(failure);
}

void FunctionTable::moved(MotionKind kind, std::chrono::nanoseconds duration, bool reached) {
  Motions& motions = motions_[static_cast<std::size_t>(kind)];
  ++motions.count;
  motions.duration += duration;
  if (!reached) cut_short_ = true;
}

std::string FunctionTable::to_text() const {
  std::string text = fmt::format("{:<10} {:<20} {:>10} {:>9} {:>11}  {}\n", "block", "function", "begin s",
                                 "FIN s", "duration s", "result");
  for (const Row& row : rows_) {
    const std::string fin = row.fin ? fmt::format("{:.2f}", seconds(*row.fin - program_begun_)) : "-";
    text += fmt::format("{:<10} {:<20} {:>10.2f} {:>9} {:>11.2f}  {}\n", row.block, row.function,
                        seconds(row.begin - program_begun_), fin, seconds(row.duration), row.result);
  }
  std::string line;
  for (std::size_t kind = 0; kind < motions_.size(); ++kind) {
    const Motions& motions = motions_[kind];
    if (motions.count == 0) continue;
    line += fmt::format("{}{} {}{} {:.2f} s", line.empty() ? "" : ", ", motions.count, names_of_one[kind],
                        motions.count == 1 ? "" : "s", seconds(motions.duration));
  }
  if (line.empty()) line = "none";
  return text + fmt::format("motion: {}{}\n", line, cut_short_ ? "; the last one was cut short" : "");
}

}  // namespace kernel_mocks
