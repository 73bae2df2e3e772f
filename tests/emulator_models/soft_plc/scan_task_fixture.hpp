// A cycle and the rig that it works, with the calls of whole scans by name.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/emulator_models/soft_plc/scan_rig.hpp"

namespace emulator_models::soft_plc {

inline const std::string first_run_scan = "ANIFXTGO";
inline const std::string run_scan = "AIFXTGO";
inline const std::string stop_scan = "AIG";

struct ScanTaskTest : ::testing::Test {
  static ScanTask make(const ScanConfig& config) {
    return ScanTask::make(config, std::chrono::nanoseconds{0}).value();
  }

  /// One scan, at the moment at which it is due.
  std::string scan(ScanTask& task) {
    rig.now = std::max(rig.now, task.period().due());
    rig.run_until_wait(task);
    return rig.take_calls();
  }
  /// In RUN, after the first scan.
  ScanTask running(const ScanConfig& config) {
    ScanTask task = make(config);
    EXPECT_TRUE(task.order_run(StartKind::cold));
    EXPECT_EQ(scan(task), config.exchanges_with_cycles ? first_run_scan : "ANIXGO");
    return task;
  }
  /// Calls `act` once, in the middle of the next step of this kind.
  template <typename Act>
  void in_the_middle_of(ScanAction action, Act act) {
    rig.during = [this, action, act](ScanAction now_done) {
      if (now_done != action) return;
      act();
      rig.during = [](ScanAction) {};
    };
  }

  ScanRig rig;
};

}  // namespace emulator_models::soft_plc
