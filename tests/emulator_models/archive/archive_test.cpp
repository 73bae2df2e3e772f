#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "emulator_models/archive/archive_writer.hpp"
#include "tests/support/shell.hpp"

namespace emulator_models::archive {
namespace {

using soft_plc::EventKind;
using soft_plc::EventRecord;
using soft_plc::EventRing;

EventRecord numbered(std::uint64_t number) {
  return {.kind = EventKind::overrun,
          .time_ns = static_cast<std::int64_t>(number) * 1'000'000,
          .scan_number = number,
          .values = {static_cast<std::int64_t>(number)}};
}

std::vector<EventRecord> numbered_from(std::uint64_t first, std::uint64_t count) {
  std::vector<EventRecord> records;
  for (std::uint64_t i = 0; i < count; ++i) records.push_back(numbered(first + i));
  return records;
}

class ArchiveTest : public testing::Test {
 protected:
  std::string query(const std::string& sql) {
    sqlite3* database = nullptr;
    sqlite3_open(config.file.c_str(), &database);
    std::string text;
    const auto add = [](void* into, int columns, char** values, char**) {
      for (int i = 0; i < columns; ++i)
        static_cast<std::string*>(into)->append(values[i] != nullptr ? values[i] : "").append(" ");
      return 0;
    };
    if (sqlite3_exec(database, sql.c_str(), add, &text, nullptr) != SQLITE_OK)
      text = sqlite3_errmsg(database);
    sqlite3_close(database);
    return text;
  }

  test_support::TemporaryFolder folder;
  ArchiveConfig config{.file = folder.path() / "plc.archive"};
};

TEST_F(ArchiveTest, each_power_up_goes_on_in_the_same_file) {
  for (std::uint64_t power_up = 1; power_up <= 2; ++power_up)
    ASSERT_TRUE(ArchiveDatabase::open(config)->append(numbered_from(power_up, 1)));
  EXPECT_EQ(query("SELECT power_up, scan_number FROM event ORDER BY id"), "1 1 2 2 ");
}

TEST_F(ArchiveTest, the_oldest_rows_make_room) {  // I2
  config.rows_max = 100;
  auto archive = ArchiveDatabase::open(config);
  for (std::uint64_t first = 0; first < 400; first += 40)
    ASSERT_TRUE(archive->append(numbered_from(first, 40)));
  EXPECT_EQ(query("SELECT count(*), min(scan_number), max(scan_number) FROM event"), "100 300 399 ");
}

TEST_F(ArchiveTest, file_and_wal_stay_within_their_bytes) {  // I3
  config.bytes_max = ArchiveConfig::bytes_min;
  config.wal_bytes_max = ArchiveConfig::wal_bytes_min;
  auto archive = ArchiveDatabase::open(config);
  for (std::uint64_t batch = 0; batch < 60; ++batch) {
    const auto stored = archive->append(numbered_from(batch * 1000, 1000));
    ASSERT_TRUE(stored) << stored.error().message;
    ASSERT_LE(std::filesystem::file_size(config.file), static_cast<std::uintmax_t>(config.bytes_max));
    ASSERT_LE(std::filesystem::file_size(config.file.string() + "-wal"),
              static_cast<std::uintmax_t>(2 * config.wal_bytes_max));
  }
  EXPECT_EQ(query("SELECT max(scan_number) FROM event"), "59999 ");
}

TEST_F(ArchiveTest, a_file_that_is_no_archive_is_refused_and_left_as_it_is) {  // I4
  const std::string text =
      "The notes of somebody, which are not to be lost, whatever the PLC is told to do.\n";
  std::ofstream{config.file} << text;
  const auto opened = ArchiveDatabase::open(config);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ArchiveErrorCode::foreign_file) << opened.error().message;
  std::ifstream file{config.file};
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>{file}, {}), text);
}

TEST_F(ArchiveTest, a_database_of_something_else_is_refused_and_left_as_it_is) {  // I4
  query("CREATE TABLE song (name)");
  const auto opened = ArchiveDatabase::open(config);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ArchiveErrorCode::foreign_file) << opened.error().message;
  EXPECT_EQ(query("SELECT name FROM sqlite_schema"), "song ");
}

TEST_F(ArchiveTest, a_damaged_archive_is_refused) {  // I4
  ASSERT_TRUE(ArchiveDatabase::open(config)->append(numbered_from(0, 2000)));
  std::fstream file{config.file, std::ios::in | std::ios::out | std::ios::binary};
  file.seekp(4096 * 8);
  file << std::string(4096 * 4, 'x');
  file.close();
  const auto opened = ArchiveDatabase::open(config);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ArchiveErrorCode::damaged_file) << opened.error().message;
}

TEST_F(ArchiveTest, a_missing_folder_and_a_limit_too_small_are_told) {
  config.file = folder.path() / "missing" / "plc.archive";
  EXPECT_EQ(ArchiveDatabase::open(config).error().code, ArchiveErrorCode::cannot_open);
  config.rows_max = 0;
  EXPECT_EQ(ArchiveDatabase::open(config).error().code, ArchiveErrorCode::limit_out_of_range);
}

TEST_F(ArchiveTest, a_producer_is_done_while_the_disk_is_blocked_and_all_is_counted) {
  auto archive = ArchiveDatabase::open(config);
  EventRing ring{64};
  sqlite3* other = nullptr;
  sqlite3_open(config.file.c_str(), &other);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  ArchiveWriter writer{std::move(*archive), {&ring}, {}, std::chrono::milliseconds{1}};
  // The lock is given back only after the last push: had a push waited for the disk, this would not end.
  for (std::uint64_t i = 0; i < 1000; ++i) (void)ring.push(numbered(i));
  while (writer.counts().errors_count[static_cast<std::size_t>(ArchiveErrorCode::busy)] == 0)
    std::this_thread::yield();
  EXPECT_EQ(writer.counts().stored_count, 0u);
  sqlite3_exec(other, "ROLLBACK", nullptr, nullptr, nullptr);
  sqlite3_close(other);
  writer.stop();
  EXPECT_GT(ring.lost_count(), 0u);
  EXPECT_EQ(query("SELECT sum(CASE kind WHEN 8 THEN v0 ELSE 1 END) FROM event"), "1000 ");
  EXPECT_NE(writer.counts().latest_error.find("plc.archive"), std::string::npos);
}

TEST_F(ArchiveTest, kill_in_the_middle_leaves_a_whole_file_with_all_rows_up_to_some_batch) {
  auto* const committed = static_cast<std::atomic<std::uint64_t>*>(
      mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(committed, MAP_FAILED);
  for (std::uint64_t kill_after = 0; kill_after < 20; ++kill_after) {
    config.file = folder.path() / std::to_string(kill_after);
    *committed = 0;
    const pid_t child = fork();
    if (child == 0) {
      auto archive = ArchiveDatabase::open(config);
      for (std::uint64_t first = 0; archive; first += 50) {
        if (!archive->append(numbered_from(first, 50))) break;
        *committed = first + 50;
      }
      _exit(1);
    }
    while (*committed < kill_after * 150 + 50 && waitpid(child, nullptr, WNOHANG) == 0)
      std::this_thread::yield();
    const std::uint64_t promised = *committed;
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child could not write";
    EXPECT_EQ(query("PRAGMA integrity_check"), "ok ");
    EXPECT_EQ(query("SELECT count(*) >= " + std::to_string(promised) +
                    ", count(*) % 50, max(scan_number) + 1 = count(*) FROM event"),
              "1 0 1 ");
  }
  munmap(committed, 4096);
}

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
