#include "emulator_models/soft_plc/configured_plc.hpp"

#include <algorithm>
#include <utility>

namespace emulator_models::soft_plc {
namespace {

bool is_same_driver(const ConfiguredDriver& a, const ConfiguredDriver& b) {
  return a.kind == b.kind && a.config.name == b.config.name && a.config.inputs == b.config.inputs &&
         a.config.period == b.config.period && a.config.late_after == b.config.late_after &&
         a.config.failures_max == b.config.failures_max &&
         a.config.stale_is_fault == b.config.stale_is_fault && a.config.stale_bit == b.config.stale_bit &&
         a.fixed_inputs == b.fixed_inputs;
}

bool is_same(const ArchiveSettings& a, const ArchiveSettings& b) {
  return a.path == b.path && a.rows_max == b.rows_max && a.signals == b.signals;
}

std::string needs_stop(const std::string& name, const std::string& change) {
  return name + ": changes " + change +
         ", which cannot be done in RUN; order STOP, load it again, and order RUN";
}

std::string refusal_of_archive(const std::string& name, const ArchiveSettings& archive,
                               const std::string& why) {
  return name + ":" + std::to_string(archive.path_place.line) + ":" +
         std::to_string(archive.path_place.column) + ": " + why;
}

/// A PLC with what watches it: whoever keeps the PLC keeps both.
struct WatchedPlc {
  std::unique_ptr<PlcObserver> observer;
  std::unique_ptr<SoftPlc> plc;
};

}  // namespace

std::string change_that_needs_stop(const PlcConfiguration& old, const PlcConfiguration& next) {
  if (old.threading != next.threading || old.realtime != next.realtime) return "threads or realtime";
  if (old.slice_intervals != next.slice_intervals) return "slice_intervals_ms";
  if (old.cycles.size() != next.cycles.size()) return "the number of cycles";
  for (std::size_t i = 0; i < next.cycles.size(); ++i) {
    const ConfiguredCycle& a = old.cycles[i];
    const ConfiguredCycle& b = next.cycles[i];
    if (a.name != b.name) return "the name of cycle " + a.name;
    if (a.source != b.source) return "the program of cycle " + a.name;
    if (a.config.priority != b.config.priority) return "the priority of cycle " + a.name;
    if (a.sends != b.sends) return "what cycle " + a.name + " sends";
    if (a.config.scan.outputs_in_stop != b.config.scan.outputs_in_stop) return "outputs_in_stop";
  }
  if (!std::ranges::equal(old.drivers, next.drivers, is_same_driver)) return "the drivers";
  if (!is_same(old.archive, next.archive)) return "the archive";
  if (old.realtime_signals != next.realtime_signals) return "the real-time data";
  return {};
}

ConfiguredPlc::ConfiguredPlc(std::string file_name, FileReader reader, DriverFactory factory, PlcClock& clock,
                             ObserverFactory observers)
    : file_name_{std::move(file_name)},
      reader_{std::move(reader)},
      factory_{std::move(factory)},
      observers_{std::move(observers)},
      clock_{clock} {}

ConfiguredPlc::~ConfiguredPlc() {
  if (plc_) plc_->gateway().close();
}

tl::expected<void, std::string> ConfiguredPlc::reload(std::string_view text, const std::string& name) {
  const std::filesystem::path folder = std::filesystem::path{file_name_}.parent_path();
  auto next = parse_configuration(text, name, folder, reader_);
  if (!next) return tl::unexpected{next.error()};
  const std::lock_guard lock{mutex_};
  const std::string change = plc_ ? change_that_needs_stop(configuration_, *next) : "all";
  if (change.empty()) {
    std::vector<ScanConfig> scans;
    for (const ConfiguredCycle& cycle : next->cycles) scans.push_back(cycle.config.scan);
    if (auto done = plc_->reconfigure(scans, next->gateway); !done) return done;
  } else {
    if (plc_ && !plc_->is_stopped()) return tl::unexpected{needs_stop(name, change)};
    if (auto built = build(*next, name, change); !built) return built;
  }
  configuration_ = std::move(*next);
  return {};
}

tl::expected<void, std::string> ConfiguredPlc::build(const PlcConfiguration& next, const std::string& name,
                                                     const std::string& change) {
  SoftPlcSetup setup;
  setup.slice_intervals = next.slice_intervals;
  setup.gateway = next.gateway;
  std::vector<const IlCycle*> programs;
  for (const ConfiguredCycle& cycle : next.cycles) {
    auto body = std::make_unique<IlCycle>(cycle.program);
    programs.push_back(body.get());
    setup.cycles.push_back({cycle.name, cycle.config, cycle.sends, std::move(body)});
  }
  for (const ConfiguredDriver& driver : next.drivers) {
    auto made = factory_(driver);
    if (!made)
      return tl::unexpected{name + ": driver " + driver.config.name + ": there is no kind \"" + driver.kind +
                            "\" in this program"};
    setup.drivers.push_back({driver.config, std::move(made)});
  }
  const std::chrono::nanoseconds power_up = clock_.now();
  auto watched = std::make_shared<WatchedPlc>();
  if (observers_) {
    auto observer = observers_(next, power_up);
    if (!observer) return tl::unexpected{refusal_of_archive(name, next.archive, observer.error())};
    watched->observer = std::move(*observer);
    setup.observer = watched->observer.get();
  }
  auto plc = SoftPlc::make(std::move(setup), power_up);
  if (!plc) return tl::unexpected{name + ": " + plc.error()};
  watched->plc = std::move(*plc);
  // Meanwhile somebody may have ordered RUN.
  if (plc_ && !plc_->retire()) return tl::unexpected{needs_stop(name, change)};
  if (plc_) plc_->gateway().close();
  threads_.reset();
  programs_ = std::move(programs);
  observer_ = watched->observer.get();
  SoftPlc* const built = watched->plc.get();
  plc_ = std::shared_ptr<SoftPlc>{std::move(watched), built};
  threads_ = std::make_unique<PlcThreads>(*plc_, clock_, next.threading, next.realtime);
  return {};
}

std::shared_ptr<SoftPlc> ConfiguredPlc::plc() const {
  const std::lock_guard lock{mutex_};
  return plc_;
}

PlcConfiguration ConfiguredPlc::configuration() const {
  const std::lock_guard lock{mutex_};
  return configuration_;
}

std::chrono::milliseconds ConfiguredPlc::answer_timeout() const {
  const std::lock_guard lock{mutex_};
  return configuration_.answer_timeout;
}

std::optional<RunTimeFault> ConfiguredPlc::run_time_fault(std::size_t index) const {
  const std::lock_guard lock{mutex_};
  return index < programs_.size() ? programs_[index]->run_time_fault() : std::nullopt;
}

RealTimeReading ConfiguredPlc::realtime_values(std::size_t index) const {
  const std::lock_guard lock{mutex_};
  RealTimeReading reading;
  if (observer_ == nullptr || index >= programs_.size()) return reading;
  const RealTimeValues* const values = observer_->values_of(index);
  if (values == nullptr) return reading;
  reading.values.resize(values->words_count());
  reading.outcome = values->read(reading.values, reading.stamp);
  return reading;
}

std::string ConfiguredPlc::realtime_refusal() const {
  const std::lock_guard lock{mutex_};
  return threads_ ? threads_->realtime_refusal() : std::string{};
}

}  // namespace emulator_models::soft_plc
