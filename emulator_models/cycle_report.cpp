#include "emulator_models/cycle_report.hpp"

#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "emulator_models/soft_plc/il_address.hpp"

namespace emulator_models {
namespace {

using soft_plc::FaultCode;
using soft_plc::ScanAction;
using soft_plc::StartDelays;
using std::chrono::nanoseconds;

/// "9.5 us", "12 us", "1.25 ms", "2 s": three digits are enough for what depends on a host.
std::string brief(nanoseconds time) {
  const auto ns = static_cast<double>(time.count());
  if (ns < 1e6) return fmt::format("{:.3g} us", ns / 1e3);
  if (ns < 1e9) return fmt::format("{:.3g} ms", ns / 1e6);
  return fmt::format("{:.3g} s", ns / 1e9);
}

std::string_view text_of(FaultCode code) {
  switch (code) {
    case FaultCode::watchdog:
      return "watchdog (1): the scan was longer than its limit";
    case FaultCode::overrun:
      return "overrun (2): a start could not be kept";
    case FaultCode::program_failed:
      return "program failed (3)";
    case FaultCode::other_cycle:
      return "stopped (4): another cycle has a fault";
    case FaultCode::io_failed:
      return "inputs failed (5): a driver brings no good ones";
  }
  return "";
}

std::string_view text_of(ScanAction action) {
  switch (action) {
    case ScanAction::system_analysis:
    case ScanAction::clear_fault:
    case ScanAction::initialise:
    case ScanAction::write_safe_outputs:
      return "system analysis";
    case ScanAction::read_inputs:
      return "read inputs";
    case ScanAction::read_from_cycles:
      return "read from cycles";
    case ScanAction::execute:
      return "execute";
    case ScanAction::write_to_cycles:
      return "write to cycles";
    case ScanAction::write_outputs:
    case ScanAction::refresh_output_image:
      return "write outputs";
    case ScanAction::wait:
    case ScanAction::enter_fault:
      return "wait";
  }
  return "";
}

std::string histogram(const StartDelays& delays) {
  std::string text = fmt::format("  {:<16}{:>12}{:>11}\n", "start late by", "scans", "share");
  const auto line = [&](const std::string& range, std::uint64_t count) {
    fmt::format_to(std::back_inserter(text), "  {:<16}{:>12}{:>9.4f} %\n", range, count,
                   100.0 * static_cast<double>(count) / static_cast<double>(delays.count()));
  };
  std::uint64_t left = delays.count();
  for (std::size_t i = 0; i < StartDelays::range_ends.size() && left > 0; ++i) {
    line("< " + brief(StartDelays::range_ends[i]), delays.count_in(i));
    left -= delays.count_in(i);
  }
  if (delays.beyond() > 0) line("more", delays.beyond());
  return text;
}

/// A bit as it is, a word also as its digits: the address does not tell whether it has a sign.
std::string value_text(const std::string& address, std::uint64_t value) {
  const auto type = soft_plc::parse_address(address).value().type;
  if (type == soft_plc::ElementaryType::boolean) return fmt::format("{} = {}", address, value);
  return fmt::format("{} = {} (16#{:0{}X})", address, value, value, 2 * soft_plc::size_bytes(type));
}

}  // namespace

std::string values_report(const std::string& name, const std::vector<std::string>& signals,
                          const soft_plc::RealTimeReading& reading) {
  if (reading.outcome == soft_plc::ReadOutcome::nothing_published)
    return fmt::format("values of cycle {}: no scan is complete yet\n", name);
  if (reading.outcome == soft_plc::ReadOutcome::busy)
    return fmt::format("values of cycle {}: its scans are too fast to be read\n", name);
  std::string text =
      fmt::format("values of cycle {} after scan {}, at {:.3f} s: ", name, reading.stamp.scan_number,
                  std::chrono::duration<double>(reading.stamp.time).count());
  for (std::size_t i = 0; i < signals.size(); ++i)
    text += (i > 0 ? ", " : "") + value_text(signals[i], reading.values[i]);
  return text + '\n';
}

std::string to_string(const soft_plc::Fault& fault) {
  return fmt::format("{}; after {} of scan {}, in {}", text_of(fault.code), brief(fault.scan_time),
                     fault.scan_number, text_of(fault.action));
}

std::string cycle_report(const std::string& name, nanoseconds period, const soft_plc::CycleStatus& status,
                         const StartDelays& delays) {
  std::string text =
      fmt::format("cycle {}, every {}: {} scans begun in RUN, {} overruns, {} lost starts\n", name,
                  brief(period), delays.count(), status.overruns_count, status.lost_starts_count);
  if (status.fault) text += "  fault: " + to_string(*status.fault) + '\n';
  if (delays.count() == 0) return text;
  text += histogram(delays);
  const auto kept = [&](std::uint64_t permille) { return brief(delays.percentile(permille)); };
  text += fmt::format("  late: median {}, 99 % {}, 99.9 % {}, most {}\n", kept(500), kept(990), kept(999),
                      brief(delays.longest()));
  const soft_plc::ScanTimes& times = status.scan_times;
  text += fmt::format("  scan time of {} whole scans: shortest {}, mean {}, longest {}\n", times.scans_count,
                      brief(times.shortest), brief(times.mean()), brief(times.longest));
  return text;
}

std::string cycle_report(const soft_plc::PlcConfiguration& configuration, soft_plc::SoftPlc& plc,
                         nanoseconds now) {
  std::string text;
  for (std::size_t i = 0; i < plc.cycles_count(); ++i)
    text += cycle_report(plc.name(i), configuration.cycles[i].config.scan.period, plc.status(i),
                         plc.start_delays(i));
  for (std::size_t i = 0; i < plc.io().drivers_count(); ++i) {
    const soft_plc::DriverState state = plc.io().state(i, now);
    text += fmt::format("driver {}: {} exchanges, {} failures, stale {} times\n", plc.io().config(i).name,
                        state.exchanges_count, state.failures_count, state.stale_count);
  }
  return text;
}

}  // namespace emulator_models
