// The choices of one execution, as deviations from the default, in a text file that survives a rebuild.
//
//   ltsim schedule 1
//   scenario  paper/time-out
//   memory    sc
//   cpu       one-fifo          (this line only where the machine has one processor)
//   races     off               (this line only where data races are no failures)
//   leaks     off               (this line only where leaks are no failures)
//   state     fork              (this line only where each execution has a process of its own)
//   outcome   invariant: I1: the answer to request 1 was delivered for request 2
//   switch    kernel/main    before atomic_load segment.state #3    to emulator/main
//   time      kernel/main    before clock_read - #2                 +20ms
//   stall     emulator/main  before atomic_store segment.state #1   +150ms
//   fault     kernel/main    before sem_post handoff #2             lost-post 1
//   crash     kernel/main    before sem_post handoff #3             of emulator
//   choose    kernel/main    asks delay #1                          3
//   older     kernel/main    before atomic_load segment.flag #2     by 1
//
// A scenario that reads an input, as a fuzz target does, has that in its schedule as well, a record a line:
//   input     "\x02010F604\x0374"
//
// One of a whole program says which, and with which arguments:
//   program   "./bank"
//   argument  "100"
//
// The default: the running task goes on until it blocks, then the task with the lowest number that can run; a
// task that yields lets the next one run; time passes only when nobody can run; the scenario's questions are
// answered with 0; no fault strikes; loads see the latest store. A "time" line lets time pass for everybody before the step, a "stall" line holds up the
// task itself and lets the others go on. A "fault" line ends with the kind of fault and with the number, from
// 1, of the way in which it strikes; a "crash" line with the process that is killed there. An "older" line (memory c11): a load does
// not see the latest store but one that is so many stores older; a store takes its place before so many that are there.
//
// A line is anchored to the step at which its choice was made, by names and not by step numbers: which task,
// before ("before") or blocked in ("in") which operation on which object, for the how-many-eth time of that
// task. "end" is the end of a task, "- start" the begin of the world. '#' at the begin of a line starts a
// comment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "sim_clock/check/outcome.hpp"
#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/explore/start_state.hpp"
#include "sim_clock/world/cpu.hpp"
#include "sim_clock/world/fault_kind.hpp"
#include "sim_clock/world/memory_model.hpp"

namespace ltsim {

/// How a schedule file begins.
inline constexpr std::string_view schedule_header = "ltsim schedule 1";

struct Deviation {
  enum class Kind : std::uint8_t { switch_task, pass_time, stall, fault, choose, older };

  Kind kind = Kind::switch_task;
  std::string anchor;                  ///< "kernel/main before sem_wait handoff #2"
  std::string to_task;                 ///< switch_task: "emulator/main"
  SimTime passes{0};                   ///< pass_time, stall
  FaultKind fault = FaultKind::crash;  ///< fault
  std::string process;                 ///< fault: of a crash, who is killed
  /// choose; fault, but for a crash: in which of its ways, from 1; older: how many stores are newer, from 1
  std::size_t answer = 0;
  std::size_t line = 0;  ///< where it stands in its file, from 1; 0: not from a file

  /// Equal as choices: the line does not matter.
  bool operator==(const Deviation& other) const noexcept {
    return kind == other.kind && anchor == other.anchor && to_task == other.to_task &&
           passes == other.passes && fault == other.fault && process == other.process &&
           answer == other.answer;
  }
};

/// One line of a schedule file, without the line's end.
[[nodiscard]] std::string to_string(const Deviation& deviation);

struct Schedule {
  std::string scenario;
  OutcomeKind outcome = OutcomeKind::passed;
  std::string message;  ///< of the outcome; one line
  Memory memory = Memory::sc;
  Cpu cpu = Cpu::many;
  Findings findings = {};
  StartState start_state = StartState::restore;
  std::vector<std::string> input = {};  ///< records of World::input(); together they are it
  /// Of a whole program: its path and its arguments; otherwise empty.
  std::vector<std::string> program = {};
  std::vector<Deviation> deviations;
};

/// See carried_bytes.hpp.
template <typename Carrier>
void carry(Carrier& carrier, Deviation& deviation) {
  carrier(deviation.kind, deviation.anchor, deviation.to_task, deviation.passes, deviation.fault,
          deviation.process, deviation.answer, deviation.line);
}
template <typename Carrier>
void carry(Carrier& carrier, Schedule& schedule) {
  carrier(schedule.scenario, schedule.outcome, schedule.message, schedule.memory, schedule.cpu,
          schedule.findings, schedule.start_state, schedule.input, schedule.program, schedule.deviations);
}

/// The lines of a schedule file that hold its input, without their ends.
[[nodiscard]] std::vector<std::string> input_lines(const Schedule& schedule);

/// The message as a schedule holds it.
[[nodiscard]] std::string one_line(std::string message);

/// The file's text.
[[nodiscard]] std::string to_string(const Schedule& schedule);

struct ScheduleError {
  std::size_t line = 0;  ///< from 1
  std::string reason;    ///< what is wrong and what would be right
};

[[nodiscard]] tl::expected<Schedule, ScheduleError> parse_schedule(std::string_view text);

}  // namespace ltsim
