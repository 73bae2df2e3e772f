// VirtualClock against a list that is searched from one end to the other.

#include <algorithm>
#include <ostream>
#include <vector>

#include <rapidcheck/state.h>

#include "property_tests/support/property.hpp"
#include "sim_clock/clock/virtual_clock.hpp"

namespace property_tests {
namespace {

using ltsim::SimTime;
using ltsim::TaskId;
using ltsim::VirtualClock;

struct Timers {
  struct Timer {
    SimTime deadline;
    TaskId sleeper;
  };
  SimTime now{0};
  std::vector<Timer> armed;  ///< in the order in which they were armed
  bool any_ever = false;

  void cancel(TaskId sleeper) {
    std::erase_if(armed, [&](const Timer& timer) { return timer.sleeper == sleeper; });
  }
  void arm(SimTime deadline, TaskId sleeper) {
    cancel(sleeper);
    armed.push_back({deadline, sleeper});
    any_ever = true;
  }
  /// Of the earliest ones the first that was armed.
  [[nodiscard]] const Timer* earliest() const {
    const auto found = std::ranges::min_element(armed, {}, &Timer::deadline);
    return found == armed.end() ? nullptr : &*found;
  }
  [[nodiscard]] TaskId due() const {
    const Timer* const timer = earliest();
    return timer == nullptr || timer->deadline > now ? VirtualClock::no_task : timer->sleeper;
  }
};

class ClockCommand : public rc::state::Command<Timers, VirtualClock> {
 public:
  void run(const Timers& before, VirtualClock& clock) const final {
    act(before, clock);
    const Timers after = nextState(before);
    RC_ASSERT(clock.now() == after.now);
    RC_ASSERT(clock.any_armed() == !after.armed.empty());
    RC_ASSERT(clock.any_armed_ever() == after.any_ever);
    RC_ASSERT(clock.next_deadline() ==
              (after.armed.empty() ? VirtualClock::never : after.earliest()->deadline));
  }

 private:
  virtual void act(const Timers& before, VirtualClock& clock) const = 0;
};

TaskId any_sleeper() {
  return *rc::gen::oneOf(rc::gen::inRange<TaskId>(0, 12), rc::gen::element<TaskId>(255));
}

class Arm final : public ClockCommand {
 public:
  void apply(Timers& timers) const override { timers.arm(deadline_, sleeper_); }
  void show(std::ostream& out) const override { out << "arm " << deadline_.count() << " for " << sleeper_; }

 private:
  void act(const Timers& /*before*/, VirtualClock& clock) const override { clock.arm(deadline_, sleeper_); }

  SimTime deadline_{
      *rc::gen::inRange(0, 40)};  // few: equal ones are not rare, nor are those that have passed
  TaskId sleeper_ = any_sleeper();
};

class Cancel final : public ClockCommand {
 public:
  void apply(Timers& timers) const override { timers.cancel(sleeper_); }
  void show(std::ostream& out) const override { out << "cancel " << sleeper_; }

 private:
  void act(const Timers& /*before*/, VirtualClock& clock) const override { clock.cancel(sleeper_); }

  TaskId sleeper_ = any_sleeper();
};

class Pass final : public ClockCommand {
 public:
  void apply(Timers& timers) const override { timers.now += duration_; }
  void show(std::ostream& out) const override { out << "pass " << duration_.count(); }

 private:
  void act(const Timers& /*before*/, VirtualClock& clock) const override { clock.pass(duration_); }

  SimTime duration_{*rc::gen::inRange(0, 10)};
};

class TakeDue final : public ClockCommand {
 public:
  void apply(Timers& timers) const override { timers.cancel(timers.due()); }
  void show(std::ostream& out) const override { out << "take due"; }

 private:
  void act(const Timers& before, VirtualClock& clock) const override {
    RC_ASSERT(clock.take_due() == before.due());
  }
};

PROPERTY(VirtualClock, wakes_as_a_sorted_list_does, ()) {
  VirtualClock clock;
  clock.reset();
  rc::state::check(Timers{}, clock,
                   rc::state::gen::execOneOfWithArgs<Arm, Arm, Arm, Cancel, Pass, TakeDue, TakeDue>());
}

}  // namespace
}  // namespace property_tests
