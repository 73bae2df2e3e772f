// What becomes of records when the disk, the file or somebody else does not let them in.
#include <atomic>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "emulator_models/archive/archive_writer.hpp"
#include "tests/emulator_models/archive/archive_rig.hpp"
#include "tests/emulator_models/archive/failing_disk.hpp"

namespace emulator_models::archive {
namespace {

using soft_plc::EventKind;
using soft_plc::EventRecord;
using soft_plc::EventRing;

class ArchiveDrainTest : public ArchiveTest {
 protected:
  /// Over `ring`, with the messages in `told`.
  ArchiveDrain& make_drain() {
    return drain.emplace(std::move(ArchiveDatabase::open(config).value()), std::vector{&ring},
                         [this](const std::string& message) { told.push_back(message); });
  }
  void push(std::uint64_t first, std::uint64_t count) {
    for (const EventRecord& record : numbered_from(first, count)) (void)ring.push(record);
  }
  std::uint64_t errors(ArchiveErrorCode code) {
    return drain->counts().errors_count[static_cast<std::size_t>(code)];
  }

  EventRing ring{1024};
  std::vector<std::string> told;
  std::optional<ArchiveDrain> drain;
};

TEST_F(ArchiveDrainTest, a_full_disk_keeps_the_batch_and_is_told_once_until_there_is_room_again) {
  FailingDisk disk;
  make_drain();
  for (int round = 1; round <= 2; ++round) {
    disk.fail_from(0, ENOSPC);
    push(0, 10);
    for (int i = 0; i < 5; ++i) drain->drain();
    EXPECT_EQ(errors(ArchiveErrorCode::disk_full), 5U * static_cast<unsigned>(round));
    EXPECT_EQ(told.size(), static_cast<std::size_t>(round));
    EXPECT_NE(told.back().find("make room on the disk"), std::string::npos) << told.back();
    disk.fail_from(-1, 0);
    drain->drain();
    EXPECT_EQ(drain->counts().stored_count, 10U * static_cast<unsigned>(round));
  }
  EXPECT_EQ(drain->counts().lost_count, 0U);
}

TEST_F(ArchiveDrainTest,
       a_file_that_can_no_longer_be_written_loses_what_finish_cannot_store_and_counts_it) {  // I3
  FailingDisk disk;
  make_drain();
  push(0, 7);
  drain->drain();
  disk.fail_from(0, EACCES);
  push(7, 2000);  // 1024 find room
  drain->finish();
  EXPECT_EQ(errors(ArchiveErrorCode::failed), std::uint64_t{ArchiveDrain::last_tries_max} + 1);
  EXPECT_EQ(drain->counts().stored_count, 7U);
  EXPECT_EQ(drain->counts().lost_count, 1024U);
  EXPECT_EQ(ring.lost_count(), 976U);
}

/// For each N: the Nth write fails, once or from there on. The batch is stored whole with the next try, or not at all.
TEST_F(ArchiveDrainTest, whichever_write_fails_no_batch_is_stored_in_part_or_twice) {  // I1 of the database
  FailingDisk disk;
  config.wal_bytes_max = ArchiveConfig::wal_bytes_min;
  for (const bool for_good : {false, true}) {
    for (int nth = 0, stored_at_once = 0; stored_at_once < 3; ++nth) {
      config.file = folder.path() / (std::to_string(nth) + (for_good ? "good" : "once"));
      disk.fail_from(-1, 0);
      auto archive = ArchiveDatabase::open(config).value();
      ASSERT_TRUE(archive.append(numbered_from(0, 2500)));  // the WAL is over its half: the next one moves it
      disk.fail_from(nth, ENOSPC, for_good);
      const bool stored = archive.append(numbered_from(2500, 500)).has_value();
      const bool was_hit = disk.writes() > nth;
      disk.fail_from(-1, 0);
      EXPECT_EQ(query("SELECT count(*) FROM event"), stored ? "3000 " : "2500 ") << nth;
      if (!stored) {
        EXPECT_TRUE(archive.append(numbered_from(2500, 500))) << nth;
      }
      EXPECT_EQ(query("SELECT count(*), max(scan_number) FROM event; PRAGMA integrity_check"),
                "3000 2999 ok ")
          << nth;
      if (!was_hit) ++stored_at_once;
      ASSERT_LT(nth, 1000);
    }
  }
}

TEST_F(ArchiveDrainTest, a_reader_who_holds_the_wal_stops_the_writing_at_its_bound_until_he_lets_go) {
  config.wal_bytes_max = ArchiveConfig::wal_bytes_min;
  make_drain();
  push(0, 1);
  drain->drain();
  OtherConnection reader{config.file};
  EXPECT_EQ(reader("BEGIN; SELECT count(*) FROM event"), "1 ");
  std::uint64_t pushed = 1;
  for (; errors(ArchiveErrorCode::busy) == 0 && pushed < 20'000; pushed += 1000) {
    push(pushed, 1000);
    drain->drain();
    ASSERT_LE(bytes_of_file_and_wal(),
              config.bytes_max + config.wal_bytes_max + ArchiveDatabase::batch_bytes(1000));
  }
  ASSERT_EQ(errors(ArchiveErrorCode::busy), 1U);
  EXPECT_EQ(drain->counts().stored_count, pushed - 1000);
  EXPECT_NE(told.at(0).find("reader"), std::string::npos) << told[0];
  EXPECT_EQ(reader("SELECT count(*) FROM event; COMMIT"), "1 ");
  drain->drain();
  EXPECT_EQ(drain->counts().stored_count, pushed);
}

TEST_F(ArchiveDrainTest, a_file_that_is_overwritten_while_in_use_is_not_touched_any_more) {
  make_drain();
  push(0, 100);
  drain->drain();
  {
    OtherConnection other{config.file};
    other("DELETE FROM event; PRAGMA wal_checkpoint(TRUNCATE)");
    std::fstream file{config.file, std::ios::in | std::ios::out | std::ios::binary};
    file << std::string(4096, 'x');
  }
  push(100, 100);
  drain->drain();
  EXPECT_EQ(errors(ArchiveErrorCode::foreign_file) + errors(ArchiveErrorCode::damaged_file), 1U);
  EXPECT_EQ(told.size(), 1U);
  push(200, 100);
  drain->drain();
  EXPECT_EQ(errors(ArchiveErrorCode::foreign_file) + errors(ArchiveErrorCode::damaged_file), 1U);
  EXPECT_EQ(drain->counts().lost_count, 200U);
}

TEST_F(ArchiveDrainTest, a_file_that_is_moved_away_while_in_use_is_told_and_not_written_any_more) {
  make_drain();
  push(0, 1);
  drain->drain();
  const auto moved = folder.path() / "moved";
  std::filesystem::rename(config.file, moved);
  push(1, 1);
  drain->drain();
  EXPECT_EQ(errors(ArchiveErrorCode::cannot_open), 1U);
  EXPECT_FALSE(std::filesystem::exists(config.file));
  std::filesystem::rename(moved, config.file);
  drain->drain();
  EXPECT_EQ(query("SELECT count(*) FROM event"), "2 ");
}

TEST_F(ArchiveDrainTest, of_a_batch_longer_than_the_archive_the_oldest_records_are_counted_as_lost) {  // I3
  config.rows_max = 100;
  make_drain();
  push(0, 250);
  drain->drain();
  EXPECT_EQ(drain->counts().stored_count, 100U);
  EXPECT_EQ(drain->counts().lost_count, 150U);
}

TEST_F(ArchiveDrainTest, the_last_gap_has_its_cycle_its_time_and_its_scan) {
  make_drain();
  for (EventRecord record : numbered_from(0, 1030)) {
    record.cycle = 3;
    (void)ring.push(record);
  }
  drain->finish();
  EXPECT_EQ(query("SELECT v0, cycle, time_ns, scan_number FROM event WHERE kind = 8"),
            "6 3 1029000000 1029 ");
}

TEST_F(ArchiveDrainTest, what_is_pushed_after_the_end_is_lost_and_counted) {  // I3
  make_drain();
  push(0, 5);
  drain->finish();
  push(5, 3);
  EXPECT_EQ(drain->counts().stored_count, 5U);
  EXPECT_EQ(ring.lost_count(), 3U);
}

TEST_F(ArchiveDrainTest, an_exception_on_the_thread_of_the_writer_is_a_counted_error) {
  FailingDisk disk;
  auto archive = ArchiveDatabase::open(config).value();
  disk.fail_from(0, ENOSPC);
  push(0, 5);
  std::atomic<int> calls{0};
  ArchiveWriter writer{std::move(archive),
                       {&ring},
                       [&](const std::string&) {
                         ++calls;
                         throw std::runtime_error{"the console is gone"};
                       },
                       std::chrono::milliseconds{1}};
  while (writer.counts().errors_count[static_cast<std::size_t>(ArchiveErrorCode::disk_full)] < 3)
    std::this_thread::yield();
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(writer.counts().errors_count[static_cast<std::size_t>(ArchiveErrorCode::failed)], 1U);
  writer.stop();
  EXPECT_EQ(writer.counts().lost_count, 5U);
}

TEST_F(ArchiveDrainTest, a_producer_is_done_while_the_disk_is_blocked_and_all_is_counted) {
  auto archive = ArchiveDatabase::open(config);
  OtherConnection other{config.file};
  ASSERT_EQ(other("BEGIN IMMEDIATE"), "");
  ArchiveWriter writer{std::move(*archive), {&ring}, {}, std::chrono::milliseconds{1}};
  // The lock is given back only after the last push: had a push waited for the disk, this would not end.
  for (std::uint64_t i = 0; i < 5000; ++i) (void)ring.push(numbered(i));
  while (writer.counts().errors_count[static_cast<std::size_t>(ArchiveErrorCode::busy)] == 0)
    std::this_thread::yield();
  EXPECT_EQ(writer.counts().stored_count, 0u);
  other("ROLLBACK");
  writer.stop();
  EXPECT_GT(ring.lost_count(), 0u);
  EXPECT_EQ(query("SELECT sum(CASE kind WHEN 8 THEN v0 ELSE 1 END) FROM event"), "5000 ");
  EXPECT_NE(writer.counts().latest_error.find("plc.archive"), std::string::npos);
}

}  // namespace
}  // namespace emulator_models::archive
