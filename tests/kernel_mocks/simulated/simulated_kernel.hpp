// For tests of the kernel's threads: logic task, runner and link in the simulated world, against a PLC that is the
// port itself. Time is simulated, so durations can be asked for exactly; a request takes none.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel_mocks/part_program_runner.hpp"
#include "tests/kernel_mocks/scripted_plc.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace kernel_mocks {

using namespace std::chrono_literals;

/// A ScriptedPlc that takes its time: it does what a PLC program does with the strobes, and the test's own.
class TimedPlc {
 public:
  using Clock = std::chrono::steady_clock;

  TimedPlc();

  ScriptedPlc port;
  /// From the strobe to FIN, by M code; at once where there is none.
  std::map<std::uint16_t, std::chrono::nanoseconds> durations;
  /// Sets a bit at a time since the program start.
  void set_later(std::chrono::nanoseconds at, std::uint16_t m, bool on) {
    do_later(at, [this, m, on] { port.set_bit(m, on); });
  }
  /// With the first request after that time.
  void do_later(std::chrono::nanoseconds at, std::function<void()> what) {
    later_.push_back({at, std::move(what)});
  }
  /// Answers again, ready for a program start, and obedient.
  void make_well();
  /// Instead of the rule that FIN follows the strobes. Gets the time since a strobe rose; nothing while none is on.
  std::function<bool(std::optional<std::chrono::nanoseconds>)> fin;

  /// When the kernel made a change for the `nth` time (from 0), since it made "program running" on; a failure when it has not.
  [[nodiscard]] std::chrono::nanoseconds time_of(std::string_view change, std::size_t nth = 0) const;
  [[nodiscard]] std::size_t count_of(std::string_view change) const;

  struct Interval {
    std::chrono::nanoseconds begin;
    std::chrono::nanoseconds end;
    [[nodiscard]] std::chrono::nanoseconds length() const { return end - begin; }
  };
  /// When DEN was off, since "program running".
  [[nodiscard]] std::vector<Interval> motions() const;

 private:
  struct Later {
    std::chrono::nanoseconds at;
    std::function<void()> what;
  };

  void scan();
  [[nodiscard]] std::optional<Clock::time_point> program_start() const;

  std::vector<Later> later_;
  std::optional<Clock::time_point> strobe_since_;
};

class SimulatedKernel : public ltsim::WorldTest {
 protected:
  SimulatedKernel();

  /// Runs `body` as the kernel's main thread, in one execution in which nothing is chosen.
  void in_world(const std::function<void()>& body);
  /// Runs a part program so, by a DirectLink.
  RunResult run_program(std::string_view text);

  TimedPlc plc;
  LogicTaskOptions logic;
  RunnerOptions runner;
  PartProgramObserver* observer = nullptr;
};

/// What the strobe byte holds, as the PLC's log shows it.
inline constexpr std::string_view den_off = "M96 byte 00";
inline constexpr std::string_view den_on = "M96 byte 80";
inline constexpr std::string_view m_strobe = "M96 byte 90";
inline constexpr std::string_view m_strobe_in_motion = "M96 byte 10";

}  // namespace kernel_mocks
