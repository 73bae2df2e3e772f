#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

#include <algorithm>

#include "kernel_mocks/nc_parser.hpp"

namespace kernel_mocks {
namespace {

constexpr std::string_view strobe_byte = "M96 byte ";

}  // namespace

TimedPlc::TimedPlc() {
  port.scan = [this](ScriptedPlc&) { scan(); };
}

void TimedPlc::make_well() {
  port.silent_from_request = 0;
  for (const int m : {122, 123, 125, 126}) port.set_bit(static_cast<std::uint16_t>(m), true);
  port.set_bit(121, false);
  fin = nullptr;
}

std::optional<TimedPlc::Clock::time_point> TimedPlc::program_start() const {
  const auto found = std::ranges::find(port.log, "M104 on");
  if (found == port.log.end()) return std::nullopt;
  return port.times[static_cast<std::size_t>(found - port.log.begin())];
}

std::chrono::nanoseconds TimedPlc::time_of(std::string_view change, std::size_t nth) const {
  const auto start = program_start();
  for (std::size_t index = 0; start && index < port.log.size(); ++index) {
    if (port.times[index] < *start || port.log[index] != change) continue;
    if (nth-- == 0) return port.times[index] - *start;
  }
  ADD_FAILURE() << "the kernel has not made this change: " << change;
  return {};
}

std::vector<TimedPlc::Interval> TimedPlc::motions() const {
  std::vector<Interval> found;
  bool moving = false;
  const auto start = program_start();
  for (std::size_t index = 0; start && index < port.log.size(); ++index) {
    if (port.times[index] < *start || !port.log[index].starts_with(strobe_byte)) continue;
    const bool den = port.log[index][strobe_byte.size()] >= '8';
    if (moving == !den) continue;
    moving = !den;
    const std::chrono::nanoseconds at = port.times[index] - *start;
    if (moving) {
      found.push_back({at, at});
    } else {
      found.back().end = at;
    }
  }
  return found;
}

std::size_t TimedPlc::count_of(std::string_view change) const {
  return static_cast<std::size_t>(std::ranges::count(port.log, change));
}

void TimedPlc::scan() {
  const auto now = Clock::now();
  if (const auto start = program_start()) {
    std::erase_if(later_, [&](const Later& later) {
      if (now - *start < later.at) return false;
      later.what();
      return true;
    });
  }
  if (!port.any_strobe()) {
    strobe_since_.reset();
  } else if (!strobe_since_) {
    strobe_since_ = now;
  }
  const auto since = strobe_since_ ? std::optional{now - *strobe_since_} : std::nullopt;
  if (fin) {
    port.set_bit(120, fin(since));
  } else {
    const auto duration = durations.find(port.word(100));
    port.set_bit(120, since && (duration == durations.end() || *since >= duration->second));
  }
}

SimulatedKernel::SimulatedKernel() { logic.poll_interval = 1ms; }

void SimulatedKernel::in_world(const std::function<void()>& body) {
  const ltsim::Outcome outcome =
      run([&](ltsim::World& world) { world.process("kernel").start("main", body); });
  EXPECT_EQ(outcome, ltsim::Outcome{});
}

RunResult SimulatedKernel::run_program(std::string_view text) {
  const Program program = parse_program(text).value();
  RunResult result;
  in_world([&] {
    FxDriver driver{plc.port, {.retries = 0}};
    LogicTask logic_task{driver, logic};
    result = PartProgramRunner{logic_task, runner, observer}.run(program);
  });
  return result;
}

}  // namespace kernel_mocks
