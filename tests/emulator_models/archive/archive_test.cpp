#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <limits>
#include <thread>

#include "tests/emulator_models/archive/archive_rig.hpp"

namespace emulator_models::archive {
namespace {

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

TEST_F(ArchiveTest, of_a_batch_longer_than_the_archive_the_newest_rows_are_stored_and_counted) {  // I1
  config.rows_max = 100;
  auto archive = ArchiveDatabase::open(config);
  EXPECT_EQ(archive->append(numbered_from(0, 100)).value(), 100U);
  EXPECT_EQ(archive->append(numbered_from(100, 250)).value(), 100U);
  EXPECT_EQ(query("SELECT count(*), min(scan_number), max(scan_number) FROM event"), "100 250 349 ");
}

TEST_F(ArchiveTest,
       a_batch_longer_than_the_file_may_be_is_cut_to_what_fits_even_with_the_longest_rows) {  // I1, I3
  config.bytes_max = ArchiveConfig::bytes_min;
  auto archive = ArchiveDatabase::open(config);
  soft_plc::EventRecord longest{.kind = soft_plc::EventKind::scans, .cycle = 0xFF, .code = 0xFFFF};
  longest.time_ns = longest.values[0] = std::numeric_limits<std::int64_t>::max();
  longest.scan_number = std::numeric_limits<std::uint64_t>::max() / 2;
  longest.values.fill(std::numeric_limits<std::int64_t>::min());
  const std::vector<soft_plc::EventRecord> batch(20'000, longest);
  for (int i = 0; i < 3; ++i) {
    const auto stored = archive->append(batch);
    ASSERT_TRUE(stored) << stored.error().message;
    EXPECT_EQ(query("SELECT count(*) FROM event"), std::to_string(*stored) + " ");
    EXPECT_LE(bytes_of_file_and_wal(),
              config.bytes_max + config.wal_bytes_max + ArchiveDatabase::batch_bytes(*stored));
  }
}

TEST_F(ArchiveTest, file_and_wal_together_stay_within_their_bytes) {  // I3
  config.bytes_max = ArchiveConfig::bytes_min;
  config.wal_bytes_max = ArchiveConfig::wal_bytes_min;
  auto archive = ArchiveDatabase::open(config);
  std::uint64_t first = 0;
  for (const std::size_t rows : {1U, 10U, 100U, 1000U, 4000U}) {
    for (int batch = 0; batch < 40; ++batch, first += rows) {
      const auto stored = archive->append(numbered_from(first, rows));
      ASSERT_TRUE(stored) << stored.error().message;
      ASSERT_LE(bytes_of_file_and_wal(),
                config.bytes_max + config.wal_bytes_max + ArchiveDatabase::batch_bytes(rows));
      ASSERT_LE(std::filesystem::file_size(config.file), static_cast<std::uintmax_t>(config.bytes_max));
    }
  }
  EXPECT_EQ(query("SELECT max(scan_number) FROM event"), std::to_string(first - 1) + " ");
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

}  // namespace
}  // namespace emulator_models::archive
