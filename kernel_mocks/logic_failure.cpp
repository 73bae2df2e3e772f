#include "kernel_mocks/logic_failure.hpp"

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

std::string to_string(const LogicFailure& failure) {
  switch (failure.fault) {
    case LogicFault::link_lost:
      return fmt::format("the link to the PLC failed: {}", to_string(failure.link));
    case LogicFault::alarm:
      return fmt::format("PLC alarm {} after {:.2f} s", failure.alarm_number, seconds(failure.after));
    case LogicFault::emergency_stop:
      return fmt::format("emergency stop after {:.2f} s", seconds(failure.after));
    case LogicFault::not_ready:
      return fmt::format("the PLC does not enable the cycle start (waited {:.2f} s)", seconds(failure.after));
    case LogicFault::fin_missing:
      return fmt::format("no FIN from the PLC within {:.2f} s", seconds(failure.after));
    case LogicFault::fin_stuck:
      return fmt::format("the PLC's FIN has not gone off within {:.2f} s", seconds(failure.after));
    case LogicFault::interrupted:
      return "interrupted";
    case LogicFault::spindle_not_at_speed:
      return fmt::format("the spindle has not come to speed within {:.2f} s", seconds(failure.after));
    case LogicFault::operator_reset:
      return "the operator pressed reset";
    case LogicFault::operator_abort:
      return "the operator ended the program";
    case LogicFault::operator_emergency_stop:
      return "the operator pressed emergency stop";
  }
  return "unknown fault";
}

}  // namespace kernel_mocks
