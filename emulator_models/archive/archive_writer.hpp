// The thread between the rings of the cycles and the archive file: looks into the rings every `interval`
// (archive_drain.hpp says what becomes of what it finds there).
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "emulator_models/archive/archive_drain.hpp"

namespace emulator_models::archive {

class ArchiveWriter {
 public:
  static constexpr std::chrono::milliseconds interval_default{100};

  /// Starts the thread; throws std::system_error when there is none.
  /// @param rings  one for each pushing thread; outlive the writer
  /// @param tell   called by the thread with the message of an error, once until something is stored again
  ArchiveWriter(ArchiveDatabase database, std::vector<soft_plc::EventRing*> rings,
                std::function<void(const std::string&)> tell,
                std::chrono::milliseconds interval = interval_default);
  /// stop()
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Stores what is in the rings and ends the thread. The cycles have ended before: what they push later is lost, and
  /// counted by their rings.
  void stop() noexcept;

  /// Any thread.
  [[nodiscard]] ArchiveCounts counts() const { return drain_.counts(); }

 private:
  void run() noexcept;
  [[nodiscard]] bool sleep();

  ArchiveDrain drain_;
  const std::chrono::milliseconds interval_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;  // mutex_
  std::thread thread_;
};

}  // namespace emulator_models::archive
