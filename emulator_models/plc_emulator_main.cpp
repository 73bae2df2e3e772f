// plc-emulator: an FX PLC that runs instruction list, with a machine behind it, on a shared-memory segment, a
// pseudo-terminal, or both.
//
// One thread scans, and tells of faults on standard error; one serves each port; the main thread waits for SIGINT or
// SIGTERM, which are blocked everywhere else, and draws the memory meanwhile.
//
// Exit codes: 0 ended by a signal; 2 bad usage, a bad program, or a segment that cannot be had; 3 our own fault.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "emulator_models/configured_emulator.hpp"
#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/emulator_options.hpp"
#include "emulator_models/exit_codes.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/fx_plc_emulator.hpp"
#include "emulator_models/fx_plc_loop.hpp"
#include "emulator_models/plant_choice.hpp"
#include "emulator_models/plc_view.hpp"
#include "emulator_models/program_loading.hpp"
#include "emulator_models/pty_server.hpp"
#include "emulator_models/scan_boundary_port.hpp"
#include "emulator_models/send_configuration.hpp"
#include "emulator_models/served_segment.hpp"

namespace {

using namespace emulator_models;

int complain(int exit_code, const std::string& message) {
  fmt::print(stderr, "plc-emulator: {}\n", message);
  return exit_code;
}

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

sigset_t stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

void wait_for_stop_signal(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
}

/// Draws until a stop signal comes. Looks once a scan or so: a change that lasts one scan is seen.
void watch_until_stop_signal(const sigset_t& signals, const FxPlcEmulator& plc, PlcView view,
                             std::chrono::nanoseconds period) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const timespec pause{.tv_sec = period.count() / ns_per_s, .tv_nsec = period.count() % ns_per_s};
  const auto start = std::chrono::steady_clock::now();
  do {
    const std::string text = view.update(plc.snapshot(), std::chrono::steady_clock::now() - start);
    if (text.empty()) continue;
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  } while (sigtimedwait(&signals, nullptr, &pause) < 0);
}

/// What the lamps and the error devices of an FX say, with the place in the program.
void tell_fault(const FxPlc& plc, const std::string& program_name) {
  constexpr const char* what_follows = "outputs off, STOP; M8035 and M8036 start it again";
  const auto& fault = plc.fault();
  if (!fault) {
    complain(exit_ended, "fault cleared, RUN");
  } else if (const auto& program_fault = plc.program_fault()) {
    complain(exit_ended,
             fmt::format("PROG-E: {}:{}: {}", program_name, to_string(*program_fault), what_follows));
  } else {
    const auto lasted = std::chrono::duration_cast<std::chrono::milliseconds>(fault->scan_time);
    complain(exit_ended, fmt::format("CPU-E: watchdog: scan {} has lasted {} ms, longer than D8000: {}",
                                     fault->scan_number, lasted.count(), what_follows));
  }
}

FxPlcConfig config_of(const EmulatorOptions& options) {
  return {.period = std::chrono::milliseconds{options.scan_period_ms},
          .watchdog_limit = std::chrono::milliseconds{options.watchdog_ms},
          // A host tells an endless program by its clock, as an FX does: the watchdog.
          .scan_instructions_max = std::numeric_limits<std::uint64_t>::max(),
          .start = options.cold ? soft_plc::StartKind::cold : soft_plc::StartKind::warm};
}

auto open_archive(const EmulatorOptions& options) {
  return archive::FxArchive::open(options.archive, options.model, std::chrono::steady_clock::now(),
                                  std::chrono::system_clock::now(),
                                  [](const std::string& message) { complain(exit_ended, message); });
}

int serve(const EmulatorOptions& options, const LoadedProgram& program, FxPlc::Plant plant) {
  // Blocked before there is anything to clean up, and before the first thread starts: all threads inherit it
  // and only the main thread takes the signals.
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  FxPlcEmulator emulator{options.model};
  const FxPlcConfig config = config_of(options);
  ScanBoundaryPort port{emulator, config.period + ScanBoundaryPort::default_patience};
  std::optional<PtyServer> pty;
  if (options.pty && !pty.emplace(port).open())
    return complain(exit_own_fault, fmt::format("no pseudo-terminal: {}", std::strerror(errno)));
  std::optional<ServedSegment> segment;
  std::optional<EmulatorHandler> handler;
  if (!options.segment_name.empty()) {
    const auto found = segment.emplace(options.segment_name, options.handoff.options()).open();
    if (!found) return complain(exit_usage, found.error());
    if (!found->empty()) complain(exit_ended, *found);
    handler.emplace(segment->slave(), port);
  }

  // From before the first scan and the first request on: no change is missed.
  const bool terminal = ::isatty(STDOUT_FILENO) == 1;
  const PlcView view{terminal ? PlcView::Style::screen : PlcView::Style::lines, emulator.snapshot(),
                     labels_of(plant_of(options))};
  FxPlc plc{emulator, program.program, std::move(plant), &port, config, std::chrono::steady_clock::now()};
  std::unique_ptr<archive::FxArchive> archive;
  if (!options.archive.path.empty()) {
    auto opened = open_archive(options);
    if (!opened) return complain(exit_usage, opened.error());
    archive = std::move(*opened);
    plc.observe_with(&archive->recorder());
  }
  FxPlcLoop loop{plc, [&](const FxPlc& changed) { tell_fault(changed, program.name); }};
  std::thread scan_thread{[&] { loop.run(); }};
  std::thread handler_thread;
  std::thread pty_thread;
  if (handler) handler_thread = std::thread{[&] { handler->run(); }};
  if (pty) pty_thread = std::thread{[&] { pty->run(); }};

  say(fmt::format("{}, a scan every {} ms", protocol::fx::to_string(options.model), options.scan_period_ms));
  if (segment) say("segment: " + options.segment_name);
  if (pty) say("pty: " + pty->path());
  if (options.watch) {
    watch_until_stop_signal(signals, emulator, view, config.period);
  } else {
    wait_for_stop_signal(signals);
  }

  if (pty) pty->request_stop();
  if (handler) handler->request_stop();
  loop.request_stop();
  scan_thread.join();
  port.close(emulator.lock());
  if (archive) complain(exit_ended, archive->stop(std::chrono::steady_clock::now()));
  if (pty_thread.joinable()) pty_thread.join();
  if (handler_thread.joinable()) handler_thread.join();
  if (segment) {
    if (const std::string told = segment->at_the_end(); !told.empty()) complain(exit_ended, told);
  }
  return exit_ended;
}

int load_and_serve(const EmulatorOptions& options) {
  const PlantKind kind = plant_of(options);
  auto plant = make_plant(kind, options.failures);
  if (!plant) return complain(exit_usage, plant.error());
  const auto program = load_program(options.program_path, kind, options.model);
  if (!program) return complain(exit_usage, program.error());
  return serve(options, *program, std::move(*plant));
}

int checked_main(int argc, char** argv) {
  EmulatorOptions options;
  CLI::App app{
      "An FX PLC that runs instruction list, with a machine behind it, for a kernel that has no PLC."};
  add_options(app, options);
  ConfiguredEmulatorOptions configured;
  add_configured_options(app, configured);
  SendConfigurationOptions sent;
  add_send_configuration_options(app, sent);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ended : exit_usage;
  }
  if (!sent.path.empty()) return run_send_configuration(sent, options);
  if (!configured.path.empty()) return run_configured_emulator(configured, options);
  if (options.segment_name.empty() && !options.pty)
    return complain(exit_usage, "nothing to serve: give --segment NAME, --pty, or both (--help)");
  return load_and_serve(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return checked_main(argc, argv);
  } catch (const std::exception& error) {
    return complain(exit_own_fault, fmt::format("internal error: {}", error.what()));
  }
}
