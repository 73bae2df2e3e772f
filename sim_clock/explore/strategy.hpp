// A strategy makes the choices of an execution; strategies differ in nothing else.
//
// Every nondeterminism of a world is a choice on one stream: which task runs, how much time passes although
// somebody could run, what a scenario asks for. Each has a default (the first option; no time passes), so
// that a schedule can be told as the few choices that deviate from it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "sim_clock/clock/virtual_clock.hpp"

namespace ltsim {

enum class ChoiceKind : std::uint8_t {
  task,      ///< which task runs next; options are task numbers, the default first
  scenario,  ///< World::choose(); options are 0, 1, 2 ...
};

/// Time that passes although somebody could run.
struct SlowMoment {
  SimTime duration{0};  ///< >= 0; 0: nothing happens
  bool others_go_on =
      false;  ///< only the task at whose step it happens gets no processor; otherwise none does
};

class Strategy {
 public:
  virtual ~Strategy() = default;

  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// Called before the first choice of an execution. All choices follow from `seed`, and from nothing else.
  virtual void begin_execution(std::uint64_t seed) noexcept = 0;

  /// @param options  at least two; options[0] is what happens by default
  /// @return         index into options
  [[nodiscard]] virtual std::size_t choose(ChoiceKind kind,
                                           std::span<const std::uint64_t> options) noexcept = 0;

  /// Whether the task that is about to take a step is held up first: its processor, or the whole machine, is
  /// slow. So a time-out may fire whose peer is merely late. Only asked while time matters to somebody.
  /// @param until_next_timer  >= 0; VirtualClock::never when no timer is armed
  /// @return                  the default is no slow moment
  [[nodiscard]] virtual SlowMoment slow_moment(SimTime until_next_timer) noexcept = 0;

 protected:
  Strategy() = default;
  Strategy(const Strategy&) = default;
  Strategy& operator=(const Strategy&) = default;
};

}  // namespace ltsim
