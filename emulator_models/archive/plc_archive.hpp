// The archive of one PLC: opens the file and stores what the rings of its recorders hold, on a thread of its own, until
// it is stopped or goes.
//
//   FxRecorder recorder{{.signals = ...}, model, power_up};
//   auto archive = PlcArchive::open({.file = ...}, {&recorder.ring()}, say);
//   plc.observe_with(&recorder);
//   ... scan ...
//   recorder.finish(now); archive->stop();
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emulator_models/archive/archive_writer.hpp"

namespace emulator_models::archive {

class PlcArchive {
 public:
  /// @param rings  one for each pushing thread; outlive the archive
  /// @param tell   called by the thread with the message of an error, once until something is stored again
  [[nodiscard]] static tl::expected<std::unique_ptr<PlcArchive>, ArchiveError> open(
      const ArchiveConfig& config, std::vector<soft_plc::EventRing*> rings,
      std::function<void(const std::string&)> tell) noexcept;

  /// The cycles have ended before: what they push later is lost, and counted.
  void stop() noexcept { writer_.stop(); }

  /// Any thread.
  [[nodiscard]] ArchiveCounts counts() const { return writer_.counts(); }
  /// Any thread. All records that are in no file: for want of room in a ring, or because the disk refused them.
  [[nodiscard]] std::uint64_t lost_count() const;

 private:
  PlcArchive(ArchiveDatabase database, std::vector<soft_plc::EventRing*> rings,
             std::function<void(const std::string&)> tell)
      : rings_{std::move(rings)}, writer_{std::move(database), rings_, std::move(tell)} {}

  const std::vector<soft_plc::EventRing*> rings_;
  ArchiveWriter writer_;
};

}  // namespace emulator_models::archive
