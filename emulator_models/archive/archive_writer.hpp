// The thread between the rings of the cycles and the archive file.
//
// It looks into the rings every `interval`, takes what is there in batches and stores each batch in one transaction.
// Nothing that the disk does reaches a scan: a batch that cannot be stored is kept and tried again, meanwhile the
// rings fill, and what finds no room there is lost and counted (event_ring.hpp). A file that has become damaged is not
// touched any more; from then on records are taken and counted as lost.
//
// Invariants
//   I1  no thread that pushes ever waits for this one: the rings are all that they share.
//   I2  records of one ring are stored in the order in which they were pushed.
//   I3  after stop() each record taken is stored or counted by lost_count.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator_models/archive/archive_database.hpp"
#include "emulator_models/soft_plc/event_ring.hpp"

namespace emulator_models::archive {

struct ArchiveCounts {
  std::uint64_t stored_count = 0;  ///< rows committed
  std::uint64_t lost_count = 0;    ///< taken from a ring, but not stored; those lost in the rings are apart
  std::array<std::uint64_t, archive_error_codes_count> errors_count{};  ///< by ArchiveErrorCode
  std::string latest_error;                                             ///< empty: none so far
};

class ArchiveWriter {
 public:
  static constexpr std::size_t batch_rows_max = 4096;
  static constexpr std::chrono::milliseconds interval_default{100};
  /// Tries of the last batches in stop(), so that it ends even if the disk does not come back.
  static constexpr int last_tries_max = 3;

  /// Starts the thread.
  /// @param rings  one for each pushing thread; outlive the writer
  /// @param tell   called by the thread with the message of an error, once until something is stored again
  ArchiveWriter(ArchiveDatabase database, std::vector<soft_plc::EventRing*> rings,
                std::function<void(const std::string&)> tell,
                std::chrono::milliseconds interval = interval_default);
  /// stop()
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Stores what is in the rings and ends the thread. The cycles have ended before, else what they push is not stored.
  void stop() noexcept;

  /// Any thread.
  [[nodiscard]] ArchiveCounts counts() const;

 private:
  void run() noexcept;
  [[nodiscard]] bool sleep();
  bool refill();
  bool store();
  void drain();
  void store_last_gaps();
  void give_up_batch();

  ArchiveDatabase database_;
  std::vector<soft_plc::EventRing*> rings_;
  std::function<void(const std::string&)> tell_;
  std::chrono::milliseconds interval_;
  std::vector<soft_plc::EventRecord> batch_;  ///< taken, not yet stored
  std::size_t batches_of_full_rings_ = 0;  ///< bounds each round: stop() ends even if somebody still pushes
  bool damaged_ = false;
  bool told_ = false;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;     // mutex_
  ArchiveCounts counts_;  // mutex_
  std::thread thread_;
};

}  // namespace emulator_models::archive
