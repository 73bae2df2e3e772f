#include "emulator_models/configured_archive.hpp"

#include <utility>

#include <fmt/format.h>

#include "emulator_models/archive/plc_archive.hpp"
#include "emulator_models/soft_plc/plc_recorder.hpp"

namespace emulator_models {
namespace {

using std::chrono::nanoseconds;

nanoseconds steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

soft_plc::PlcRecorderConfig recorder_config(const soft_plc::ArchiveSettings& settings) {
  soft_plc::PlcRecorderConfig config;
  // The configuration was refused if one of them were none.
  for (const std::string& signal : settings.signals)
    config.signals.push_back(soft_plc::parse_address(signal).value());
  return config;
}

class ConfiguredArchive final : public soft_plc::PlcObserver {
 public:
  ConfiguredArchive(const soft_plc::PlcConfiguration& configuration, nanoseconds power_up,
                    std::function<void(const std::string&)> tell)
      : recorder_{recorder_config(configuration.archive), configuration.cycles.size(), power_up},
        tell_{std::move(tell)} {}
  ConfiguredArchive(const ConfiguredArchive&) = delete;
  ConfiguredArchive& operator=(const ConfiguredArchive&) = delete;
  ~ConfiguredArchive() override {
    if (!archive_) return;
    recorder_.finish(steady_now());
    archive_->stop();
    tell_(fmt::format("archive: {} rows stored, {} records lost", archive_->counts().stored_count,
                      archive_->lost_count()));
  }

  tl::expected<void, std::string> open(const archive::ArchiveConfig& config) {
    auto opened = archive::PlcArchive::open(config, recorder_.rings(), tell_);
    if (!opened) return tl::unexpected{std::move(opened.error().message)};
    archive_ = std::move(*opened);
    return {};
  }

  void step_ordered(std::size_t cycle, const soft_plc::ScanTask& task, const soft_plc::CycleImage& image,
                    nanoseconds now) noexcept override {
    recorder_.step_ordered(cycle, task, image, now);
  }
  void program_failed(std::size_t cycle, soft_plc::SourcePlace place) noexcept override {
    recorder_.program_failed(cycle, place);
  }
  void gateway_writes(std::size_t cycle, const soft_plc::GatewayItem& item) noexcept override {
    recorder_.gateway_writes(cycle, item);
  }

 private:
  soft_plc::PlcRecorder recorder_;
  std::function<void(const std::string&)> tell_;
  std::unique_ptr<archive::PlcArchive> archive_;
};

}  // namespace

tl::expected<std::unique_ptr<soft_plc::PlcObserver>, std::string> open_configured_archive(
    const soft_plc::PlcConfiguration& configuration, nanoseconds power_up,
    const std::function<void(const std::string&)>& tell) {
  const soft_plc::ArchiveSettings& settings = configuration.archive;
  if (settings.path.empty()) return nullptr;
  std::vector<std::string> programs;
  for (const soft_plc::ConfiguredCycle& cycle : configuration.cycles) programs.push_back(cycle.program_path);
  const nanoseconds since_power_up = steady_now() - power_up;
  auto archive = std::make_unique<ConfiguredArchive>(configuration, power_up, tell);
  const auto opened = archive->open(
      {.file = settings.path,
       .rows_max = settings.rows_max,
       .power_up_wall_clock = std::chrono::system_clock::now().time_since_epoch() - since_power_up,
       .signal_names = settings.signals,
       .program_files = std::move(programs)});
  if (!opened) return tl::unexpected{opened.error()};
  return archive;
}

}  // namespace emulator_models
