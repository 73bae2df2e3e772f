#include "emulator_models/archive/plc_archive.hpp"

#include <exception>
#include <utility>

namespace emulator_models::archive {

tl::expected<std::unique_ptr<PlcArchive>, ArchiveError> PlcArchive::open(
    const ArchiveConfig& config, std::vector<soft_plc::EventRing*> rings,
    std::function<void(const std::string&)> tell) noexcept try {
  auto database = ArchiveDatabase::open(config);
  if (!database) return tl::unexpected{std::move(database.error())};
  return std::unique_ptr<PlcArchive>{new PlcArchive{std::move(*database), std::move(rings), std::move(tell)}};
} catch (const std::exception& thrown) {  // no memory, no thread
  return tl::unexpected{ArchiveError{ArchiveErrorCode::failed, thrown.what()}};
}

std::uint64_t PlcArchive::lost_count() const {
  std::uint64_t lost = counts().lost_count;
  for (const soft_plc::EventRing* ring : rings_) lost += ring->lost_count();
  return lost;
}

}  // namespace emulator_models::archive
