#include <fstream>

#include "tests/emulator_models/archive/archive_rig.hpp"

namespace emulator_models::archive {
namespace {

using soft_plc::EventKind;
using soft_plc::EventRecord;

EventRecord at(std::int64_t seconds, EventKind kind, std::uint16_t code, std::array<std::int64_t, 5> values) {
  return {.kind = kind,
          .code = code,
          .time_ns = seconds * 1'000'000'000,
          .scan_number = static_cast<std::uint64_t>(seconds),
          .values = values};
}

class ArchiveQueriesTest : public ArchiveTest {
 protected:
  /// Two hours with something of each kind.
  ArchiveQueriesTest() {
    config.signal_names = {"coolant flow"};
    EXPECT_TRUE(ArchiveDatabase::open(config)->append(std::vector{
        at(0, EventKind::mode_change, 1, {}),
        at(1, EventKind::scans, 0, {1000, 100'000, 300'000, 150'000'000, 2}),
        at(2, EventKind::overrun, 0, {7'000'000}), at(3, EventKind::signal_change, 0, {0, 1}),
        at(4, EventKind::port_write, 0, {100, 2, 5}), at(5, EventKind::records_lost, 0, {17}),
        at(3700, EventKind::scans, 0, {900, 100'000, 9'500'000, 150'000'000, 40}),
        at(3701, EventKind::fault, 1, {6, 150'000'001}), at(3702, EventKind::fault_cleared, 1, {}),
        at(3703, EventKind::fault, 3, {6, 1'000'000, 12, 3}), at(3704, EventKind::mode_change, 0, {}),
        at(3705, EventKind::fault, 1, {6, 160'000'000})}));
  }
  /// What the shell prints, columns parted by |.
  std::string shell(const std::string& sql) {
    std::ofstream{folder.path() / "query.sql"} << sql << '\n';
    const auto result = test_support::run_in(folder.path(), "sqlite3 plc.archive < query.sql");
    EXPECT_EQ(result.exit_code, 0) << sql << '\n' << result.output;
    return result.output;
  }
  void SetUp() override {
    if (test_support::run_in(folder.path(), "sqlite3 --version").exit_code != 0)
      GTEST_SKIP() << "no sqlite3 shell";
  }
};

/// Each line that begins with "    SELECT".
TEST_F(ArchiveQueriesTest, the_queries_of_the_readme_run_in_the_sqlite3_shell_and_find_something) {
  std::ifstream readme{LTSIM_SOURCE_DIR "/emulator_models/archive/README.md"};
  std::string all;
  int queries = 0;
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with("    SELECT")) continue;
    ++queries;
    const std::string found = shell(line);
    EXPECT_NE(found, "") << line;
    all += found;
  }
  EXPECT_GE(queries, 13);
  // The answers of the day, in the words of the views.
  for (const char* const answer :
       {"watchdog|2|1970-01-01 01:01:45.000\nprogram failed|1|",  // faults by code
        "1970-01-01 00:00|0|2\n1970-01-01 01:00|0|40\n",          // overruns by hour
        "1970-01-01 01:01:40.000|0|3700|9.5|0.166667\n",          // the longest scan first
        "0|RUN|1\n0|STOP|1\n",                                    // changes of mode
        "17 records\n",                                           // the gap
        "3704.0|0|mode|STOP\n3703.0|0|fault|program failed in execute at 12:3\n3702.0|0|fault cleared|"}) {
    EXPECT_NE(all.find(answer), std::string::npos) << answer << "\nis not in\n" << all;
  }
}

}  // namespace
}  // namespace emulator_models::archive
