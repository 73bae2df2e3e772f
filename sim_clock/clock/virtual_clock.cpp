#include "sim_clock/clock/virtual_clock.hpp"

namespace ltsim {

void VirtualClock::reset() noexcept {
  now_ = SimTime{0};
  armed_ever_ = 0;
  while (armed_count_ != 0) slot_of_[heap_[--armed_count_].sleeper] = not_armed;
}

void VirtualClock::arm(SimTime deadline, TaskId sleeper) noexcept {
  cancel(sleeper);
  rise(armed_count_++, Timer{.deadline = deadline, .order = armed_ever_++, .sleeper = sleeper});
}

void VirtualClock::cancel(TaskId sleeper) noexcept {
  if (slot_of_[sleeper] != not_armed) remove(slot_of_[sleeper]);
}

TaskId VirtualClock::take_due() noexcept {
  if (armed_count_ == 0 || heap_[0].deadline > now_) return no_task;
  const TaskId sleeper = heap_[0].sleeper;
  remove(0);
  return sleeper;
}

void VirtualClock::place(std::size_t slot, const Timer& timer) noexcept {
  heap_[slot] = timer;
  slot_of_[timer.sleeper] = static_cast<std::uint16_t>(slot);
}

void VirtualClock::rise(std::size_t slot, const Timer& timer) noexcept {
  while (slot != 0) {
    const std::size_t parent = (slot - 1) / 2;
    if (!timer.before(heap_[parent])) break;
    place(slot, heap_[parent]);
    slot = parent;
  }
  place(slot, timer);
}

void VirtualClock::sink(std::size_t slot, const Timer& timer) noexcept {
  for (std::size_t child = 2 * slot + 1; child < armed_count_; child = 2 * slot + 1) {
    if (child + 1 < armed_count_ && heap_[child + 1].before(heap_[child])) ++child;
    if (!heap_[child].before(timer)) break;
    place(slot, heap_[child]);
    slot = child;
  }
  place(slot, timer);
}

void VirtualClock::remove(std::size_t slot) noexcept {
  slot_of_[heap_[slot].sleeper] = not_armed;
  const Timer last = heap_[--armed_count_];
  if (slot == armed_count_) return;
  // The last timer may belong above or below the hole.
  if (slot != 0 && last.before(heap_[(slot - 1) / 2])) {
    rise(slot, last);
  } else {
    sink(slot, last);
  }
}

}  // namespace ltsim
