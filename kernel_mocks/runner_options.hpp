// What a run of a part program may be told beforehand.
#pragma once

#include <chrono>

#include "kernel_mocks/machine_table.hpp"
#include "kernel_mocks/motion.hpp"
#include "kernel_mocks/operator_panel.hpp"

namespace kernel_mocks {

struct RunnerOptions {
  /// M0 (and M1, when its switch is on) goes on at once, as if cycle start had been pressed.
  bool continue_at_stop = false;
  /// The operator's switch for M1: off, M1 does nothing and the PLC does not see it.
  bool optional_stop = false;
  /// Must outlive the runner.
  const MachineTable* machine_table = &MachineTable::standard();
  AxisOptions axes{};
  /// Longest wait for "spindle at speed" before a motion at feed.
  std::chrono::nanoseconds spindle_timeout = std::chrono::seconds{10};
  /// May be nullptr: nobody is there. With a panel a stop waits for cycle start.
  OperatorPanel* panel = nullptr;
  /// May be nullptr; presses the panel, which must be there.
  Operator* operator_ = nullptr;
};

}  // namespace kernel_mocks
