// Takes what is in the rings and stores it in the archive file, batch by batch, each in one transaction. No thread and
// no clock of its own: archive_writer.hpp calls it from one, a test or a simulation whenever it likes.
//
// Nothing that the disk does reaches a scan: a batch that cannot be stored is kept and tried again with the next
// drain(), meanwhile the rings fill, and what finds no room there is lost and counted (event_ring.hpp). A file that
// has become damaged is not touched any more; from then on records are taken and counted as lost.
//
// Invariants
//   I1  who pushes and who drains share nothing but the rings: no push ever waits.
//   I2  records of one ring are stored in the order in which they were pushed.
//   I3  after finish() each record that was ever pushed is stored, or counted by lost_count or by its ring's
//       lost_count().
// drain() and finish(): one thread at a time. No exception leaves them: it is counted as an error.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "emulator_models/archive/archive_database.hpp"
#include "emulator_models/soft_plc/event_ring.hpp"

namespace emulator_models::archive {

struct ArchiveCounts {
  std::uint64_t stored_count = 0;  ///< rows committed
  std::uint64_t lost_count =
      0;  ///< records taken from a ring, but not stored; those lost in the rings are apart
  std::array<std::uint64_t, archive_error_codes_count> errors_count{};  ///< by ArchiveErrorCode
  std::string latest_error;                                             ///< empty: none so far
};

class ArchiveDrain {
 public:
  static constexpr std::size_t batch_rows_max = 4096;
  /// Tries of the last batches in finish(), so that it ends even if the disk does not come back.
  static constexpr int last_tries_max = 3;

  /// @param rings  one for each pushing thread; outlive the drain
  /// @param tell   called with the message of an error, once until something is stored again; may be empty
  ArchiveDrain(ArchiveDatabase database, std::vector<soft_plc::EventRing*> rings,
               std::function<void(const std::string&)> tell);
  ArchiveDrain(const ArchiveDrain&) = delete;
  ArchiveDrain& operator=(const ArchiveDrain&) = delete;

  /// Until the rings are empty or the disk refuses; what is pushed faster than that has to wait for the next call.
  void drain() noexcept;
  /// The last call: stores what is left, with a row for each gap that none tells of yet, and closes the rings.
  void finish() noexcept;

  /// Any thread.
  [[nodiscard]] ArchiveCounts counts() const;

 private:
  bool refill();
  bool store();
  void store_batches();
  void store_last_gaps();
  void give_up_batch();
  void note(ArchiveErrorCode code, const char* message) noexcept;
  template <typename Work>
  void count_exceptions_of(Work work) noexcept;

  ArchiveDatabase database_;
  std::vector<soft_plc::EventRing*> rings_;
  std::function<void(const std::string&)> tell_;
  std::vector<soft_plc::EventRecord> batch_;  ///< taken, not yet stored
  std::size_t batches_of_full_rings_ = 0;     ///< bounds each call: it ends even if somebody still pushes
  bool file_is_lost_ = false;
  bool told_ = false;

  mutable std::mutex mutex_;
  ArchiveCounts counts_;  // mutex_
};

}  // namespace emulator_models::archive
