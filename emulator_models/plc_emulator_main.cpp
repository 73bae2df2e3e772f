// plc-emulator: an FX PLC with a small machine behind it, on a shared-memory segment, a pseudo-terminal, or
// both.
//
// One thread scans, one serves each port; the main thread waits for SIGINT or SIGTERM, which are blocked
// everywhere else, and draws the memory meanwhile.
//
// Exit codes: 0 ended by a signal; 2 bad usage, or a segment that cannot be had; 3 our own fault.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "emulator_models/configured_emulator.hpp"
#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/emulator_options.hpp"
#include "emulator_models/fx_plc_emulator.hpp"
#include "emulator_models/plc_view.hpp"
#include "emulator_models/pty_server.hpp"
#include "emulator_models/scan_cycle.hpp"
#include "emulator_models/served_segment.hpp"

namespace {

using namespace emulator_models;

constexpr int exit_ended = 0;
constexpr int exit_usage = 2;
constexpr int exit_own_fault = 3;

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
                             std::chrono::milliseconds period) {
  const timespec pause{.tv_sec = period.count() / 1000, .tv_nsec = period.count() % 1000 * 1'000'000};
  const auto start = std::chrono::steady_clock::now();
  do {
    const std::string text = view.update(plc.snapshot(), std::chrono::steady_clock::now() - start);
    if (text.empty()) continue;
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  } while (sigtimedwait(&signals, nullptr, &pause) < 0);
}

int serve(const EmulatorOptions& options) {
  // Blocked before there is anything to clean up, and before the first thread starts: all threads inherit it
  // and only the main thread takes the signals.
  const sigset_t signals = stop_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  FxPlcEmulator plc{options.model};
  MachineProgram program;
  MachinePlant plant;
  const std::chrono::milliseconds scan_period{options.scan_period_ms};
  ScanCycle scan{plc, program, plant, scan_period};

  std::optional<PtyServer> pty;
  if (options.pty && !pty.emplace(plc).open())
    return complain(exit_own_fault, fmt::format("no pseudo-terminal: {}", std::strerror(errno)));
  std::optional<ServedSegment> segment;
  std::optional<EmulatorHandler> handler;
  if (!options.segment_name.empty()) {
    const auto found = segment.emplace(options.segment_name, options.paper).open();
    if (!found) return complain(exit_usage, found.error());
    if (!found->empty()) complain(exit_ended, *found);
    handler.emplace(segment->slave(), plc);
  }

  // From before the first scan and the first request on: no change is missed.
  const bool terminal = ::isatty(STDOUT_FILENO) == 1;
  const PlcView view{terminal ? PlcView::Style::screen : PlcView::Style::lines, plc.snapshot()};
  std::thread scan_thread{[&] { scan.run(); }};
  std::thread handler_thread;
  std::thread pty_thread;
  if (handler) handler_thread = std::thread{[&] { handler->run(); }};
  if (pty) pty_thread = std::thread{[&] { pty->run(); }};

  say(fmt::format("{}, a scan every {} ms", protocol::fx::to_string(options.model), options.scan_period_ms));
  if (segment) say("segment: " + options.segment_name);
  if (pty) say("pty: " + pty->path());
  if (options.watch) {
    watch_until_stop_signal(signals, plc, view, scan_period);
  } else {
    wait_for_stop_signal(signals);
  }

  if (pty) pty->request_stop();
  if (handler) handler->request_stop();
  scan.request_stop();
  if (pty_thread.joinable()) pty_thread.join();
  if (handler_thread.joinable()) handler_thread.join();
  scan_thread.join();
  if (segment && segment->kernel_is_attached())
    complain(exit_ended, "a kernel is still attached; it has to be started again to find the next emulator");
  return exit_ended;
}

int checked_main(int argc, char** argv) {
  EmulatorOptions options;
  CLI::App app{"An FX PLC with a small machine behind it, for a kernel that has no PLC."};
  add_options(app, options);
  ConfiguredEmulatorOptions configured;
  add_configured_options(app, configured);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ended : exit_usage;
  }
  if (!configured.path.empty()) return run_configured_emulator(configured, options);
  if (options.segment_name.empty() && !options.pty)
    return complain(exit_usage, "nothing to serve: give --segment NAME, --pty, or both (--help)");
  return serve(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return checked_main(argc, argv);
  } catch (const std::exception& error) {
    return complain(exit_own_fault, fmt::format("internal error: {}", error.what()));
  }
}
