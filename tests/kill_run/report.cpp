#include "tests/kill_run/report.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <map>
#include <numeric>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace kill_run {

namespace {

using Durations = std::vector<std::chrono::nanoseconds>;

/// By protocol::hardened::Phase.
constexpr std::array<std::string_view, 9> phase_names{"raw",    "idle", "request", "busy",      "response",
                                                      "orphan", "lost", "down",    "no segment"};
/// By protocol::ExchangeOutcome.
constexpr std::array<std::string_view, 4> outcome_names{"ok", "rejected", "not executed", "unknown"};

std::string quantiles(std::string_view what, Durations durations) {
  if (durations.empty()) return fmt::format("  {:<44} none\n", what);
  std::ranges::sort(durations);
  const auto at = [&durations](std::size_t thousandths) {
    const auto found = durations[(durations.size() - 1) * thousandths / 1000];
    return std::chrono::duration<double, std::milli>(found).count();
  };
  return fmt::format("  {:<44} {:>7}   {:>9.3f} {:>9.3f} {:>9.3f}\n", what, durations.size(), at(500),
                     at(990), at(1000));
}

std::string kills_table(const RunResult& result) {
  std::string text = fmt::format("kills, by the state word they left   {:>9} {:>9}\n", "kernel", "emulator");
  const auto& [kernel, emulator] = result.kills;
  const auto row = [&text](std::string_view name, std::uint64_t of_kernel, std::uint64_t of_emulator) {
    fmt::format_to(std::back_inserter(text), "  {:<34} {:>9} {:>9}\n", name, of_kernel, of_emulator);
  };
  for (std::size_t i = 0; i < phase_names.size(); ++i) row(phase_names.at(i), kernel.at(i), emulator.at(i));
  constexpr std::uint64_t none = 0;
  row("all", std::accumulate(kernel.begin(), kernel.end(), none),
      std::accumulate(emulator.begin(), emulator.end(), none));
  text +=
      fmt::format("  at a step of an exchange {}, both at once {}; removals of the segment {}, killed {}\n",
                  result.kills_at_steps, result.kills_of_both, result.removals, result.removals_killed);
  return text;
}

std::string requests_table(const Tally& tally) {
  std::string text = fmt::format("requests                             {:>9}\n", tally.submitted);
  const auto row = [&text](std::string_view name, std::uint64_t count) {
    fmt::format_to(std::back_inserter(text), "  {:<34} {:>9}\n", name, count);
  };
  for (std::size_t i = 0; i < outcome_names.size(); ++i) row(outcome_names.at(i), tally.outcomes.at(i));
  row("none: their kernel was killed", tally.without_outcome);
  row("executed", tally.executed);
  row("  of them unknown", tally.unknown_but_executed);
  row("  of them without outcome", tally.executed_without_outcome);
  row("withdrawn", tally.withdrawn);
  row("given up in busy", tally.given_up);
  row("processes left and came again", tally.closed);
  return text;
}

}  // namespace

std::string to_text(const RunResult& result) {
  const Tally& tally = result.accounts.tally;
  std::string text = kills_table(result) + requests_table(tally);
  text +=
      fmt::format("{:<46} {:>7}   {:>9} {:>9} {:>9}\n", "times in ms", "count", "median", "99 %", "longest");
  text += quantiles("a call", tally.usual_calls);
  text += quantiles("a fresh call, after a kill", tally.fresh_calls);
  text += quantiles("from a kill to the end of a fresh call", result.recoveries);
  return text;
}

std::string to_text(std::span<const std::string> accusations) {
  constexpr std::size_t shown_max = 10;
  std::string text;
  for (const std::string& accusation : accusations.first(std::min(shown_max, accusations.size())))
    fmt::format_to(std::back_inserter(text), "{}\n", accusation);
  if (accusations.size() > shown_max) text += "...\n";
  std::map<std::string_view, std::size_t> counts;
  for (const std::string& accusation : accusations)
    ++counts[std::string_view(accusation).substr(0, accusation.find(':'))];
  text += "kill-run: accusations";
  std::string_view separator = ": ";
  for (const auto& [invariant, count] : counts) {
    fmt::format_to(std::back_inserter(text), "{}{} of {}", separator, count, invariant);
    separator = ", ";
  }
  return text + '\n';
}

}  // namespace kill_run
