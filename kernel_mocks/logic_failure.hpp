// Why the logic task could not go on.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "kernel_mocks/fx_driver.hpp"

namespace kernel_mocks {

enum class LogicFault : std::uint8_t {
  link_lost,                ///< an exchange with the PLC failed
  alarm,                    ///< the PLC reports an alarm
  emergency_stop,           ///< the emergency-stop chain is open
  not_ready,                ///< the PLC does not allow a cycle start
  fin_missing,              ///< no FIN within the time-out
  fin_stuck,                ///< FIN did not go off within the time-out
  interrupted,              ///< somebody asked for a stop
  spindle_not_at_speed,     ///< a motion at feed waited for it in vain
  operator_reset,           ///< the operator pressed reset
  operator_abort,           ///< the operator ended the program
  operator_emergency_stop,  ///< the operator pressed the kernel's emergency stop
};

struct LogicFailure {
  LogicFault fault = LogicFault::link_lost;
  /// For alarm: the PLC's alarm number; 0 when it could not be read.
  std::uint16_t alarm_number = 0;
  /// For link_lost.
  FxDriverError link = FxDriverError::no_answer;
  /// Since the wait began.
  std::chrono::nanoseconds after{0};
};

/// "PLC alarm 17", "no FIN from the PLC within 10.0 s"
[[nodiscard]] std::string to_string(const LogicFailure& failure);

}  // namespace kernel_mocks
