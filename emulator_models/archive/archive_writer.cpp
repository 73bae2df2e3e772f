#include "emulator_models/archive/archive_writer.hpp"

#include <utility>

namespace emulator_models::archive {

ArchiveWriter::ArchiveWriter(ArchiveDatabase database, std::vector<soft_plc::EventRing*> rings,
                             std::function<void(const std::string&)> tell, std::chrono::milliseconds interval)
    : drain_{std::move(database), std::move(rings), std::move(tell)}, interval_{interval} {
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

void ArchiveWriter::run() noexcept {
  do {
    drain_.drain();
  } while (sleep());
  drain_.finish();
}

/// @return false = stop
bool ArchiveWriter::sleep() {
  std::unique_lock lock{mutex_};
  return !wake_.wait_for(lock, interval_, [this] { return stop_; });
}

}  // namespace emulator_models::archive
