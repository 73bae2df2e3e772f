#include "tests/scenarios/function_monitor.hpp"

#include <fmt/format.h>

namespace scenarios {
namespace {

using emulator_models::DeviceMemory;
using protocol::fx::Device;
using protocol::fx::DeviceKind;

struct Signals {
  char letter;
  Device value;
  Device strobe;
};
constexpr std::array<Signals, 3> signals{{{'M', {DeviceKind::d, 100}, {DeviceKind::m, 100}},
                                          {'S', {DeviceKind::d, 101}, {DeviceKind::m, 101}},
                                          {'T', {DeviceKind::d, 102}, {DeviceKind::m, 102}}}};
constexpr Device reset{DeviceKind::m, 105};
constexpr Device fin{DeviceKind::m, 120};
constexpr Device alarm{DeviceKind::m, 121};

char letter_of(kernel_mocks::FunctionKind kind) noexcept {
  switch (kind) {
    case kernel_mocks::FunctionKind::m:
      return 'M';
    case kernel_mocks::FunctionKind::s:
      return 'S';
    case kernel_mocks::FunctionKind::t:
      return 'T';
  }
  return '?';
}

}  // namespace

void FunctionMonitor::program_begins() { counts_.clear(); }

void FunctionMonitor::strobe_raised(kernel_mocks::FunctionKind kind, std::uint16_t number) noexcept {
  const Function function{letter_of(kind), number};
  ++counts_[function].strobes;
  world_.note([&] { return fmt::format("STROBE {}", name(function)); });
}

void FunctionMonitor::finished(kernel_mocks::FunctionKind kind, std::uint16_t number,
                               std::chrono::nanoseconds /*duration*/) noexcept {
  const Function function{letter_of(kind), number};
  world_.note([&] { return fmt::format("FIN {}", name(function)); });
  Counts& counts = counts_[function];
  if (counts.executed != 1 && !is_excused_) {
    const ltsim::GhostScope ghost;
    world_.violated(fmt::format("I27: {} was acknowledged, and the PLC has executed it {} times",
                                name(function), counts.executed));
  }
  counts = {};
}

void FunctionMonitor::excuse() noexcept {
  if (!is_excused_) world_.note([] { return std::string{"I27 is judged no more"}; });
  is_excused_ = true;
}

void FunctionMonitor::plc_is_dead() noexcept {
  seen_ = {};
  fin_ = false;
}

void FunctionMonitor::scanned(const DeviceMemory& memory) {
  const bool is_cut_short = memory.get(alarm) != 0 || memory.get(reset) != 0;
  const bool is_finished = memory.get(fin) != 0;
  // What a kernel that was killed has left under way came to its end, perhaps, but not for the next program.
  if (memory.get(reset) != 0)
    for (auto& [function, counts] : counts_) counts.executed = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    Seen& seen = seen_[i];
    if (memory.get(signals[i].strobe) == 0 || is_cut_short) {
      seen.under_way = false;
      continue;
    }
    if (!seen.under_way && !fin_) {
      seen = {true, {signals[i].letter, static_cast<std::uint16_t>(memory.get(signals[i].value))}};
      world_.note([&] { return fmt::format("BEGIN {}", name(seen.function)); });
    }
    if (!seen.under_way || !is_finished || fin_) continue;
    ++counts_[seen.function].executed;
    world_.note([&] { return fmt::format("END {}", name(seen.function)); });
  }
  fin_ = is_finished;
}

void FunctionMonitor::check_at_end() {
  if (is_excused_) return;
  for (const auto& [function, counts] : counts_) {
    world_.require(counts.strobes == 0,
                   fmt::format("I27: {} was strobed and never acknowledged", name(function)));
    world_.require(counts.executed == 0,
                   fmt::format("I27: {} was executed without a strobe", name(function)));
  }
}

std::string FunctionMonitor::name(const Function& function) {
  return fmt::format("{}{}", function.letter, function.number);
}

}  // namespace scenarios
