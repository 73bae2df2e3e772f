#include "tests/scenarios/function_monitor.hpp"

#include <fmt/format.h>

namespace scenarios {
namespace {

template <class Kind>
char letter_of(Kind kind) noexcept {
  switch (kind) {
    case Kind::m:
      return 'M';
    case Kind::s:
      return 'S';
    case Kind::t:
      return 'T';
  }
  return '?';
}

}  // namespace

void FunctionMonitor::strobe_raised(kernel_mocks::FunctionKind kind, std::uint16_t number) noexcept {
  const Function function{letter_of(kind), number};
  ++counts_[function].strobes;
  world_.note([&] { return fmt::format("STROBE {}", name(function)); });
}

void FunctionMonitor::finished(kernel_mocks::FunctionKind kind, std::uint16_t number,
                               std::chrono::nanoseconds /*duration*/) noexcept {
  const Function function{letter_of(kind), number};
  world_.note([&] { return fmt::format("FIN {}", name(function)); });
  ++counts_[function].acknowledged;
  check_acknowledged(function, counts_[function]);
}

void FunctionMonitor::action_started(emulator_models::FunctionKind kind, std::uint16_t number) noexcept {
  const Function function{letter_of(kind), number};
  world_.note([&] { return fmt::format("BEGIN {}", name(function)); });
  ++counts_[function].started;
}

void FunctionMonitor::action_finished(emulator_models::FunctionKind kind, std::uint16_t number) noexcept {
  const Function function{letter_of(kind), number};
  world_.note([&] { return fmt::format("END {}", name(function)); });
  ++counts_[function].executed;
}

void FunctionMonitor::check_at_end() {
  for (const auto& [function, counts] : counts_) {
    check_acknowledged(function, counts);
    world_.require(counts.strobes == counts.acknowledged,
                   fmt::format("I27: {} was strobed {} times and acknowledged {} times", name(function),
                               counts.strobes, counts.acknowledged));
  }
}

void FunctionMonitor::check_acknowledged(const Function& function, const Counts& counts) {
  if (counts.started == counts.acknowledged && counts.executed == counts.acknowledged) return;
  const ltsim::GhostScope ghost;
  world_.require(
      false, fmt::format("I27: {} was acknowledged {} times; the PLC began it {} times and ended it {} times",
                         name(function), counts.acknowledged, counts.started, counts.executed));
}

std::string FunctionMonitor::name(const Function& function) {
  return fmt::format("{}{}", function.letter, function.number);
}

}  // namespace scenarios
