// What happened in a failing execution, told on one screen: the choices that differ from the default, the steps
// around them, who wrote what somebody else then read, and the verdict.
//
//     story: 7 of 24 steps
//          1.100us  lathe/main         reads    parts.count = 0
//       -> lathe/main is stopped before its write parts.count #1; mill/main runs
//          1.700us  mill/main          reads    parts.count = 0
//          1.800us  mill/main          writes   parts.count := 1
//          2.000us  lathe/main         writes   parts.count := 1
//       => invariant: a part was not counted
//
// Steps are weighed, and the heaviest are kept: a switch, and what it tore apart, weighs more than a value that
// passes from one task to another, that more than a wait, and that more than what concerns one task only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "sim_clock/check/outcome.hpp"
#include "sim_clock/explore/anchor_tracker.hpp"
#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/world/step_listener.hpp"

namespace ltsim {

class Story final : public StepListener {
 public:
  static constexpr std::size_t lines_max = 24;

  /// @param schedule  the one that is replayed; it must outlive the story
  Story(World& world, const Schedule& schedule);

  /// After the execution and before the world's next one. At most lines_max lines, each ends with '\n'.
  [[nodiscard]] std::string text(const Outcome& outcome);

  void arrives(const Task& task, const Operation& operation) noexcept override;
  void performs(const Task& task, const Operation& operation) noexcept override;
  void blocks(const Task& task) noexcept override;
  void held_up(const Task& task, SimTime duration) noexcept override;
  void goes_on(const Task& task) noexcept override;
  void ends(const Task& task) noexcept override;
  void older(const Task& task, const OlderStore& taken) noexcept override;
  void asks(const Task* task, std::string_view what) noexcept override;
  void notes(std::string_view text) noexcept override;

 private:
  static constexpr TaskId nobody = VirtualClock::no_task;

  struct Event {
    enum class Kind : std::uint8_t { step, waits, note, deviation };

    Kind kind = Kind::step;
    TaskId task = nobody;
    TaskId writer = nobody;         // of a read: whose value it is
    bool is_read_by_other = false;  // of a write
    SimTime at{0};
    Operation operation{};
    std::uint64_t before = 0;
    std::uint64_t after = 0;
    std::uint32_t newer_count = 0;  // stores of a weak memory that are newer than what it found or stored
    std::size_t text = 0;           // index: of a note in notes_, of a deviation in the schedule
  };
  /// One line to be: steps of the same kind in a row are told together.
  struct Line {
    std::size_t first = 0;  // of its events
    std::vector<std::size_t> events;
    int weight = 0;
  };

  /// Called where choices are made: those of the schedule that belong here are part of the story.
  void stand_here(TaskId task);
  void finish_write() noexcept;
  [[nodiscard]] std::vector<Line> lines() const;
  [[nodiscard]] bool joins(const Line& line, const Event& next) const;
  void weigh(std::vector<Line>& lines) const;
  [[nodiscard]] std::string describe(const Line& line) const;
  [[nodiscard]] std::string describe(const Deviation& deviation) const;
  [[nodiscard]] std::string field(const Operation& operation) const;

  World& world_;
  const Schedule& schedule_;
  AnchorTracker anchors_;
  std::unordered_map<std::string, std::vector<std::size_t>> deviations_at_;  // by anchor
  std::vector<Event> events_;
  std::vector<std::string> notes_;
  std::map<std::uint64_t, std::size_t> last_write_;  // by byte: index of the event
  std::optional<std::size_t>
      before_last_write_;             // of the last event of all that writes: whose bytes it has taken
  bool write_is_unfinished_ = false;  // that of the last event of all that is a step
  std::size_t unfinished_write_ = 0;
};

}  // namespace ltsim
