#include "emulator_models/archive/archive_writer.hpp"

#include <utility>

namespace emulator_models::archive {

using soft_plc::EventKind;
using soft_plc::EventRecord;
using soft_plc::EventRing;

ArchiveWriter::ArchiveWriter(ArchiveDatabase database, std::vector<EventRing*> rings,
                             std::function<void(const std::string&)> tell, std::chrono::milliseconds interval)
    : database_{std::move(database)}, rings_{std::move(rings)}, tell_{std::move(tell)}, interval_{interval} {
  std::size_t records = 0;
  for (const EventRing* ring : rings_) records += ring->capacity();
  batches_of_full_rings_ = records / batch_rows_max + 2;  // 2: a part of one, and the batch that was kept
  batch_.reserve(batch_rows_max);
  thread_ = std::thread{[this] { run(); }};
}

ArchiveWriter::~ArchiveWriter() { stop(); }

void ArchiveWriter::stop() noexcept {
  {
    const std::lock_guard lock{mutex_};
    stop_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

ArchiveCounts ArchiveWriter::counts() const {
  const std::lock_guard lock{mutex_};
  return counts_;
}

void ArchiveWriter::run() noexcept {
  do {
    drain();
  } while (sleep());
  for (int tries = 0; tries < last_tries_max && (!batch_.empty() || refill()); ++tries) drain();
  // What the disk still refuses is given up, ring after ring, so that all is counted.
  for (std::size_t i = 0; i < batches_of_full_rings_ && (!batch_.empty() || refill()); ++i) give_up_batch();
  store_last_gaps();
}

/// @return false = stop
bool ArchiveWriter::sleep() {
  std::unique_lock lock{mutex_};
  return !wake_.wait_for(lock, interval_, [this] { return stop_; });
}

/// Takes from all rings as much as fits into a batch.
/// @return whether there is something in it
bool ArchiveWriter::refill() {
  batch_.resize(batch_rows_max);
  std::size_t filled = 0;
  for (EventRing* ring : rings_) filled += ring->take(std::span{batch_}.subspan(filled));
  batch_.resize(filled);
  return filled != 0;
}

/// Until the rings are empty or the disk refuses; what is pushed faster than that has to wait for the next round.
void ArchiveWriter::drain() {
  for (std::size_t i = 0; i < batches_of_full_rings_; ++i) {
    if (batch_.empty() && !refill()) return;
    if (!store()) return;
  }
}

bool ArchiveWriter::store() {
  if (damaged_) {
    give_up_batch();
    return true;
  }
  auto stored = database_.append(batch_);
  if (stored) {
    const std::lock_guard lock{mutex_};
    counts_.stored_count += batch_.size();
    batch_.clear();
    told_ = false;
    return true;
  }
  damaged_ = stored.error().code == ArchiveErrorCode::damaged_file;
  {
    const std::lock_guard lock{mutex_};
    ++counts_.errors_count[static_cast<std::size_t>(stored.error().code)];
    counts_.latest_error = stored.error().message;
  }
  if (!std::exchange(told_, true) && tell_) tell_(stored.error().message);
  return false;
}

void ArchiveWriter::give_up_batch() {
  const std::lock_guard lock{mutex_};
  counts_.lost_count += batch_.size();
  batch_.clear();
}

/// A ring tells of a gap with the next record; after the last one nobody does.
void ArchiveWriter::store_last_gaps() {
  for (const EventRing* ring : rings_) {
    if (const std::uint64_t lost = ring->lost_unreported(); lost != 0)
      batch_.push_back({.kind = EventKind::records_lost, .values = {static_cast<std::int64_t>(lost)}});
  }
  if (!batch_.empty() && !store()) give_up_batch();
}

}  // namespace emulator_models::archive
