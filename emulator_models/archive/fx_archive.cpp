#include "emulator_models/archive/fx_archive.hpp"

#include <exception>
#include <utility>

#include <fmt/format.h>

namespace emulator_models::archive {
namespace {

using protocol::fx::Device;
using soft_plc::SignalRecorder;

tl::expected<std::vector<Device>, std::string> signals_of(const std::vector<std::string>& names,
                                                          protocol::fx::Model model) {
  if (names.size() > SignalRecorder::signals_max)
    return tl::unexpected{fmt::format("{} signals are too many for the archive; name at most {}",
                                      names.size(), SignalRecorder::signals_max)};
  std::vector<Device> devices;
  for (const std::string& name : names) {
    const auto device = protocol::fx::parse_device(name, model);
    if (!device)
      return tl::unexpected{fmt::format("signal {} of the archive: {}", name, to_string(device.error()))};
    if (protocol::fx::width_bits(*device) != 1)
      return tl::unexpected{
          fmt::format("signal {} of the archive is a word; name bits: X0, Y17, M100, S0, TS0, CS0", name)};
    devices.push_back(*device);
  }
  return devices;
}

}  // namespace

tl::expected<std::unique_ptr<FxArchive>, std::string> FxArchive::open(
    const FxArchiveOptions& options, protocol::fx::Model model, SteadyTime power_up,
    WallTime power_up_wall_clock, std::function<void(const std::string&)> tell) noexcept try {
  auto signals = signals_of(options.signals, model);
  if (!signals) return tl::unexpected{std::move(signals.error())};
  ArchiveConfig config{.file = options.path,
                       .rows_max = options.rows_max,
                       .power_up_wall_clock = std::chrono::duration_cast<std::chrono::nanoseconds>(
                           power_up_wall_clock.time_since_epoch())};
  for (const Device signal : *signals) config.signal_names.push_back(to_string(signal));
  std::unique_ptr<FxArchive> archive{new FxArchive{{.signals = std::move(*signals)}, model, power_up}};
  auto opened = PlcArchive::open(config, {&archive->recorder_.ring()}, std::move(tell));
  if (!opened) return tl::unexpected{std::move(opened.error().message)};
  archive->archive_ = std::move(*opened);
  return archive;
} catch (const std::exception& thrown) {
  return tl::unexpected{std::string{thrown.what()}};
}

std::string FxArchive::stop(SteadyTime now) {
  recorder_.finish(now);
  archive_->stop();
  return fmt::format("archive: {} rows stored, {} records lost", archive_->counts().stored_count,
                     archive_->lost_count());
}

}  // namespace emulator_models::archive
