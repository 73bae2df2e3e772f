#include "emulator_models/archive/archive_drain.hpp"

#include <algorithm>
#include <exception>
#include <span>
#include <utility>

namespace emulator_models::archive {

using soft_plc::EventKind;
using soft_plc::EventRecord;
using soft_plc::EventRing;

namespace {

/// What records_lost records tell is counted by their ring already.
std::uint64_t records_of(std::span<const EventRecord> rows) noexcept {
  return static_cast<std::uint64_t>(std::ranges::count_if(
      rows, [](const EventRecord& row) { return row.kind != EventKind::records_lost; }));
}

}  // namespace

ArchiveDrain::ArchiveDrain(ArchiveDatabase database, std::vector<EventRing*> rings,
                           std::function<void(const std::string&)> tell)
    : database_{std::move(database)}, rings_{std::move(rings)}, tell_{std::move(tell)} {
  std::size_t records = 0;
  for (const EventRing* ring : rings_) records += ring->capacity();
  batches_of_full_rings_ = records / batch_rows_max + 2;  // 2: a part of one, and the batch that was kept
  batch_.reserve(std::max(batch_rows_max, rings_.size()));
}

ArchiveCounts ArchiveDrain::counts() const {
  const std::lock_guard lock{mutex_};
  return counts_;
}

template <typename Work>
void ArchiveDrain::count_exceptions_of(Work work) noexcept {
  try {
    work();
  } catch (const std::exception& thrown) {
    note(ArchiveErrorCode::failed, thrown.what());
  } catch (...) {
    note(ArchiveErrorCode::failed, "an exception of an unknown type");
  }
}

void ArchiveDrain::drain() noexcept {
  count_exceptions_of([this] { store_batches(); });
}

void ArchiveDrain::finish() noexcept {
  for (int tries = 0; tries < last_tries_max && (!batch_.empty() || refill()); ++tries) drain();
  // What the disk still refuses is given up, ring after ring, so that all is counted.
  for (std::size_t i = 0; i < batches_of_full_rings_ && (!batch_.empty() || refill()); ++i) give_up_batch();
  count_exceptions_of([this] { store_last_gaps(); });
  for (EventRing* ring : rings_) ring->close();
}

/// Takes from all rings as much as fits into a batch. Allocates nothing.
/// @return whether there is something in it
bool ArchiveDrain::refill() {
  batch_.resize(batch_rows_max);
  std::size_t filled = 0;
  for (EventRing* ring : rings_) filled += ring->take(std::span{batch_}.subspan(filled));
  batch_.resize(filled);
  return filled != 0;
}

void ArchiveDrain::store_batches() {
  for (std::size_t i = 0; i < batches_of_full_rings_; ++i) {
    if (batch_.empty() && !refill()) return;
    if (!store()) return;
  }
}

bool ArchiveDrain::store() {
  if (file_is_lost_) {
    give_up_batch();
    return true;
  }
  const auto stored = database_.append(batch_);
  if (stored) {
    const std::lock_guard lock{mutex_};
    counts_.stored_count += *stored;
    counts_.lost_count += records_of(std::span{batch_}.first(batch_.size() - *stored));
    batch_.clear();
    told_ = false;
    return true;
  }
  const ArchiveError& error = stored.error();
  file_is_lost_ =
      error.code == ArchiveErrorCode::damaged_file || error.code == ArchiveErrorCode::foreign_file;
  note(error.code, error.message.c_str());
  if (!std::exchange(told_, true) && tell_) tell_(error.message);
  return false;
}

void ArchiveDrain::note(ArchiveErrorCode code, const char* message) noexcept {
  const std::lock_guard lock{mutex_};
  ++counts_.errors_count[static_cast<std::size_t>(code)];
  try {
    counts_.latest_error = message;
  } catch (const std::exception&) {
    counts_.latest_error.clear();  // no memory for the text; the count tells
  }
}

void ArchiveDrain::give_up_batch() {
  const std::lock_guard lock{mutex_};
  counts_.lost_count += records_of(batch_);
  batch_.clear();
}

/// A ring tells of a gap with the next record; after the last one nobody does.
void ArchiveDrain::store_last_gaps() {
  for (const EventRing* ring : rings_) {
    if (const auto gap = ring->gap()) batch_.push_back(*gap);
  }
  if (!batch_.empty() && !store()) give_up_batch();
}

}  // namespace emulator_models::archive
