#include "emulator_models/configured_emulator.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <CLI/CLI.hpp>

#include "emulator_models/configured_observer.hpp"
#include "emulator_models/configured_port.hpp"
#include "emulator_models/cycle_report.hpp"
#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/exit_codes.hpp"
#include "emulator_models/plant_drivers.hpp"
#include "emulator_models/pty_server.hpp"
#include "emulator_models/served_segment.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using soft_plc::ConfiguredPlc;
using soft_plc::SoftPlc;
using std::chrono::steady_clock;

constexpr timespec look_interval{.tv_sec = 0, .tv_nsec = 10'000'000};
constexpr auto handled_signals = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2};

void complain(const std::string& message) { fmt::print(stderr, "plc-emulator: {}\n", message); }

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

/// Segment and pseudo-terminal, each served by a thread.
class Ports {
 public:
  explicit Ports(IPlcEmulator& plc) : plc_{plc} {}
  Ports(const Ports&) = delete;
  Ports& operator=(const Ports&) = delete;
  ~Ports() {
    if (pty_) pty_->request_stop();
    if (handler_) handler_->request_stop();
    for (std::thread& thread : threads_) thread.join();
    if (segment_) {
      if (const std::string told = segment_->at_the_end(); !told.empty()) complain(told);
    }
  }

  /// @return an exit code; exit_ended: all that is asked for is served
  int open(const EmulatorOptions& options) {
    if (options.pty && !pty_.emplace(plc_).open()) {
      complain(fmt::format("no pseudo-terminal: {}", std::strerror(errno)));
      return exit_own_fault;
    }
    if (!options.segment_name.empty()) {
      const auto found = segment_.emplace(options.segment_name, options.handoff.options()).open();
      if (!found || !found->empty()) complain(found ? *found : found.error());
      if (!found) return exit_usage;
      handler_.emplace(segment_->slave(), plc_);
      threads_.emplace_back([this] { handler_->run(); });
      say("segment: " + options.segment_name);
    }
    if (pty_) {
      threads_.emplace_back([this] { pty_->run(); });
      say("pty: " + pty_->path());
    }
    return exit_ended;
  }

 private:
  IPlcEmulator& plc_;
  std::optional<PtyServer> pty_;
  std::optional<ServedSegment> segment_;
  std::optional<EmulatorHandler> handler_;
  std::vector<std::thread> threads_;
};

/// Tells RUN, STOP, faults, lamp and a refused SCHED_FIFO, each once.
class Watcher {
 public:
  void look(const ConfiguredPlc& configured) {
    const auto plc = configured.plc();
    if (plc != plc_) {
      plc_ = plc;
      told_.assign(plc->cycles_count(), std::nullopt);
    }
    // The threads ask for it themselves, so that the answer comes some time after their start.
    if (std::string refusal = configured.realtime_refusal(); refusal != refusal_) {
      refusal_ = std::move(refusal);
      if (!refusal_.empty()) complain(refusal_);
    }
    const bool stopped = plc->is_stopped();
    if (stopped != stopped_) say(stopped ? "STOP" : "RUN");
    stopped_ = stopped;
    const bool lamp = plc->alarm_lamp();
    if (lamp != lamp_) complain(lamp ? "alarm lamp on, outputs are safe" : "alarm lamp off");
    lamp_ = lamp;
    for (std::size_t i = 0; i < told_.size(); ++i) {
      const auto fault = plc->status(i).fault;
      if (fault && fault != told_[i]) complain(describe(configured, i, *fault));
      told_[i] = fault;
    }
  }

 private:
  std::string describe(const ConfiguredPlc& configured, std::size_t index,
                       const soft_plc::Fault& fault) const {
    std::string text = fmt::format("fault in cycle {}: {}", plc_->name(index), to_string(fault));
    const auto place = configured.run_time_fault(index);
    if (place && fault.code == soft_plc::FaultCode::program_failed)
      text +=
          fmt::format("\n{}:{}", configured.configuration().cycles[index].program_path, to_string(*place));
    return text;
  }

  std::shared_ptr<SoftPlc> plc_;
  std::vector<std::optional<soft_plc::Fault>> told_;
  std::string refusal_;
  bool stopped_ = true;
  bool lamp_ = false;
};

class ConfiguredEmulator {
 public:
  explicit ConfiguredEmulator(const ConfiguredEmulatorOptions& options)
      : options_{options}, plc_{options.path, soft_plc::read_file, make_driver, clock_, make_observer} {}

  int run(const EmulatorOptions& port) {
    if (const std::string refusal = load(); !refusal.empty()) {
      complain(refusal);
      return exit_usage;
    }
    ConfiguredPort programming_port{plc_, over_the_wire_};
    Ports ports{programming_port};
    if (const int code = ports.open(port); code != exit_ended) return code;
    introduce();
    static_cast<void>(plc_.plc()->order_run(soft_plc::StartKind::cold));
    watch();
    const std::lock_guard lock{mutex_};
    plc_.plc()->stop_now();
    watcher_.look(plc_);
    report();
    return exit_ended;
  }

 private:
  static tl::expected<std::unique_ptr<soft_plc::PlcObserver>, std::string> make_observer(
      const soft_plc::PlcConfiguration& configuration, std::chrono::nanoseconds power_up) {
    return make_configured_observer(configuration, power_up, complain);
  }

  /// @return why the file is refused; empty if it is in use
  std::string load() {
    const auto text = soft_plc::read_file(options_.path);
    if (!text) return options_.path + " cannot be read; check path and permissions";
    const auto done = plc_.reload(*text);
    return done ? std::string{} : done.error();
  }

  void introduce() const {
    const auto configuration = plc_.configuration();
    say(fmt::format(
        "{}: {} cycles {}", options_.path, configuration.cycles.size(),
        configuration.threading == soft_plc::PlcThreading::one ? "on one thread" : "on a thread for each"));
    if (!configuration.archive.path.empty()) say("archive: " + configuration.archive.path);
  }

  void watch() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : handled_signals) sigaddset(&signals, signal);
    const auto end = steady_clock::now() + std::chrono::seconds{options_.seconds};
    while (options_.seconds == 0 || steady_clock::now() < end) {
      const int signal = sigtimedwait(&signals, nullptr, &look_interval);
      const std::lock_guard lock{mutex_};
      watcher_.look(plc_);
      if (signal == SIGINT || signal == SIGTERM) return;
      if (signal == SIGHUP) reload();
      if (signal == SIGUSR1) report();
      if (signal == SIGUSR2) turn_switch();
    }
  }

  void reload() {
    const auto before = plc_.plc();
    tell_change(load(), "loaded again", before);
  }

  /// On the thread of a port.
  tl::expected<void, std::string> reload_over_the_wire(std::string_view text) {
    const std::lock_guard lock{mutex_};
    const auto before = plc_.plc();
    // Without a name: the sender knows the file, and puts it in front of the place.
    auto done = plc_.reload(text, {});
    tell_change(done ? std::string{} : "over the wire" + done.error(), "loaded over the wire", before);
    return done;
  }

  void tell_change(const std::string& refusal, const std::string& loaded,
                   const std::shared_ptr<SoftPlc>& before) const {
    if (!refusal.empty()) {
      complain("refused, the configuration of before goes on: " + refusal);
    } else if (plc_.plc() == before) {
      say(loaded + "; counts from the next scan of each cycle on");
    } else {
      say(loaded + ": a new PLC, in STOP; SIGUSR2 starts it");
    }
  }

  void turn_switch() {
    const auto plc = plc_.plc();
    if (!plc->is_stopped()) {
      plc->order_stop();
    } else if (!plc->order_reset() || !plc->order_run(soft_plc::StartKind::cold)) {
      complain("RUN refused: a cycle has not come back from where it was stopped");
    }
  }

  void report() {
    const auto configuration = plc_.configuration();
    std::string text = cycle_report(configuration, *plc_.plc(), clock_.now());
    if (!configuration.realtime_signals.empty()) {
      for (std::size_t i = 0; i < configuration.cycles.size(); ++i)
        text += values_report(configuration.cycles[i].name, configuration.realtime_signals,
                              plc_.realtime_values(i));
    }
    say(text);
  }

  const ConfiguredEmulatorOptions& options_;
  soft_plc::SteadyPlcClock clock_;
  ConfiguredPlc plc_;
  Watcher watcher_;
  /// A configuration over the wire comes on another thread than signals: what changes the PLC, and what looks at it with
  /// its configuration, goes one after the other.
  std::mutex mutex_;
  ConfigurationService over_the_wire_{[this](std::string_view text) { return reload_over_the_wire(text); }};
};

}  // namespace

void add_configured_options(CLI::App& app, ConfiguredEmulatorOptions& options) {
  const std::vector<CLI::Option*> others = app.get_options();
  CLI::Option* const config = app.add_option("--config", options.path, "Run the soft PLC of this TOML file");
  app.add_option("--seconds", options.seconds, "With --config: end after this time")
      ->check(CLI::Range(1, 10'000'000))
      ->needs(config);
  // What belongs to the port is served for a configured PLC, too; all else is said in the file.
  constexpr std::array fx_only{"--model", "--program", "--plant", "--scan-period-ms", "--watch", "--archive"};
  for (CLI::Option* const other : others) {
    if (std::ranges::any_of(fx_only, [&](const char* name) { return other->check_name(name); }))
      config->excludes(other);
  }
}

int run_configured_emulator(const ConfiguredEmulatorOptions& options, const EmulatorOptions& port) {
  // Before the first thread starts: all of them inherit it, and this one takes the signals.
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : handled_signals) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  // Linux rounds the waits of ordinary threads up by 50 us unless told otherwise; threads inherit this, too.
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  return ConfiguredEmulator{options}.run(port);
}

}  // namespace emulator_models
