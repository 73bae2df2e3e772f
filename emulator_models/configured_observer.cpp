#include "emulator_models/configured_observer.hpp"

#include <utility>

#include <fmt/format.h>

#include "emulator_models/archive/plc_archive.hpp"
#include "emulator_models/soft_plc/plc_recorder.hpp"

namespace emulator_models {
namespace {

using std::chrono::nanoseconds;

nanoseconds steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

std::vector<soft_plc::DirectAddress> addresses_of(const std::vector<std::string>& texts) {
  std::vector<soft_plc::DirectAddress> addresses;
  // The configuration was refused if one of them were none.
  for (const std::string& text : texts) addresses.push_back(soft_plc::parse_address(text).value());
  return addresses;
}

soft_plc::PlcRecorderConfig recorder_config(const soft_plc::PlcConfiguration& configuration) {
  const bool has_archive = !configuration.archive.path.empty();
  return {.signals = addresses_of(configuration.archive.signals),
          .values = addresses_of(configuration.realtime_signals),
          .ring_records = has_archive ? soft_plc::PlcRecorderConfig::ring_records_default
                                      : soft_plc::EventRing::capacity_min};
}

class ConfiguredObserver final : public soft_plc::PlcObserver {
 public:
  ConfiguredObserver(const soft_plc::PlcConfiguration& configuration, nanoseconds power_up,
                     std::function<void(const std::string&)> tell)
      : recorder_{recorder_config(configuration), configuration.cycles.size(), power_up},
        tell_{std::move(tell)} {}
  ConfiguredObserver(const ConfiguredObserver&) = delete;
  ConfiguredObserver& operator=(const ConfiguredObserver&) = delete;
  ~ConfiguredObserver() override {
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
  const soft_plc::RealTimeValues* values_of(std::size_t cycle) const noexcept override {
    return &recorder_.values(cycle);
  }

 private:
  soft_plc::PlcRecorder recorder_;
  std::function<void(const std::string&)> tell_;
  std::unique_ptr<archive::PlcArchive> archive_;
};

}  // namespace

tl::expected<std::unique_ptr<soft_plc::PlcObserver>, std::string> make_configured_observer(
    const soft_plc::PlcConfiguration& configuration, nanoseconds power_up,
    const std::function<void(const std::string&)>& tell) {
  const soft_plc::ArchiveSettings& settings = configuration.archive;
  if (settings.path.empty() && configuration.realtime_signals.empty()) return nullptr;
  const nanoseconds since_power_up = steady_now() - power_up;
  auto observer = std::make_unique<ConfiguredObserver>(configuration, power_up, tell);
  if (settings.path.empty()) return observer;
  std::vector<std::string> programs;
  for (const soft_plc::ConfiguredCycle& cycle : configuration.cycles) programs.push_back(cycle.program_path);
  const auto opened = observer->open(
      {.file = settings.path,
       .rows_max = settings.rows_max,
       .power_up_wall_clock = std::chrono::system_clock::now().time_since_epoch() - since_power_up,
       .signal_names = settings.signals,
       .program_files = std::move(programs)});
  if (!opened) return tl::unexpected{opened.error()};
  return observer;
}

}  // namespace emulator_models
