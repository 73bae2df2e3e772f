#include <fstream>

#include "tests/emulator_models/archive/archive_rig.hpp"

namespace emulator_models::archive {
namespace {

using soft_plc::EventKind;
using soft_plc::EventRecord;

/// The queries of the README, each line that begins with "    SELECT", through the sqlite3 shell.
TEST_F(ArchiveTest, the_queries_of_the_readme_run_in_the_sqlite3_shell) {
  if (test_support::run_in(folder.path(), "sqlite3 --version").exit_code != 0)
    GTEST_SKIP() << "no sqlite3 shell";
  config.signal_names = {"coolant flow"};
  ASSERT_TRUE(ArchiveDatabase::open(config)->append(std::vector<EventRecord>{
      {.kind = EventKind::scans, .time_ns = 1, .values = {1000, 100'000, 300'000, 150'000'000, 2}},
      numbered(7),
      {.kind = EventKind::fault, .code = 1, .time_ns = 2, .scan_number = 8, .values = {6, 150'000'001}},
      {.kind = EventKind::mode_change, .code = 1},
      {.kind = EventKind::port_write, .values = {100, 2, 5}},
      {.kind = EventKind::signal_change, .values = {0, 1}}}));
  std::ifstream readme{LTSIM_SOURCE_DIR "/emulator_models/archive/README.md"};
  int queries = 0;
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with("    SELECT")) continue;
    ++queries;
    std::ofstream{folder.path() / "query.sql"} << line << '\n';
    const auto result = test_support::run_in(folder.path(), "sqlite3 plc.archive < query.sql");
    EXPECT_EQ(result.exit_code, 0) << line << '\n' << result.output;
    EXPECT_NE(result.output, "") << line;
  }
  EXPECT_GE(queries, 5);
}

}  // namespace
}  // namespace emulator_models::archive
