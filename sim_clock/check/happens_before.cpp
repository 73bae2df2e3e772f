#include "sim_clock/check/happens_before.hpp"

#include <algorithm>
#include <bit>

namespace ltsim {
namespace {

constexpr std::size_t slots_at_first = 256;

// What the compilers pass are the values of their __ATOMIC_ macros, in GCC with hints for lock elision above.
constexpr int order_mask = 0xff;

}  // namespace

bool acquires(int order) noexcept {
  switch (order & order_mask) {
    case __ATOMIC_CONSUME:
    case __ATOMIC_ACQUIRE:
    case __ATOMIC_ACQ_REL:
    case __ATOMIC_SEQ_CST:
      return true;
    default:
      return false;
  }
}

bool releases(int order) noexcept {
  switch (order & order_mask) {
    case __ATOMIC_RELEASE:
    case __ATOMIC_ACQ_REL:
    case __ATOMIC_SEQ_CST:
      return true;
    default:
      return false;
  }
}

bool is_seq_cst(int order) noexcept { return (order & order_mask) == __ATOMIC_SEQ_CST; }

HappensBefore::HappensBefore() : slots_(slots_at_first) {}

void HappensBefore::reset() noexcept {
  clocks_.reset();
  slots_used_ = 0;
  if (++generation_ != 0) return;
  std::fill(slots_.begin(), slots_.end(), Slot{});
  generation_ = 1;
}

void HappensBefore::begins(TaskId task) {
  clocks_.make_room_for(task);
  tasks_[task] = {.now = clocks_.take(), .fenced = none, .received = none, .family = none};
  if (follows_family_) tasks_[task].family = clocks_.take();
  tick(task);  // 0 is what everybody knows of everybody
}

void HappensBefore::follows(TaskId later, TaskId earlier) noexcept {
  clocks_.join(tasks_[later].now, tasks_[earlier].now);
  if (follows_family_) {
    clocks_.join(tasks_[later].family, tasks_[earlier].family);
    Ticks& known = clocks_.at(tasks_[later].family)[earlier];
    known = std::max(known, now(earlier));
  }
  tick(earlier);  // a creator goes on, and what it does then is not covered
}

void HappensBefore::release(TaskId task, SyncKey key) {
  const Row handed_over = find_or_add(key);
  clocks_.join(handed_over, tasks_[task].now);
  tick(task);
}

void HappensBefore::acquire(TaskId task, SyncKey key) noexcept {
  const Row handed_over = find(key);
  if (handed_over != none) clocks_.join(tasks_[task].now, handed_over);
}

void HappensBefore::forget(SyncKey key) noexcept {
  const Row handed_over = find(key);
  if (handed_over != none) clocks_.clear(handed_over);
}

void HappensBefore::before_atomic(TaskId task, SyncKey key, AtomicAccess access, int order) {
  if (!reads(access)) return;
  const Row handed_over = find(key);
  if (handed_over != none) receive(tasks_[task], handed_over, order);
}

void HappensBefore::after_atomic(TaskId task, SyncKey key, AtomicAccess access, int order) {
  if (!writes(access)) return;
  const TaskClocks& self = tasks_[task];
  Row handed_over = find(key);
  const Row hands_over = releases(order) ? self.now : self.fenced;
  if (hands_over == none) {
    // A relaxed store ends the release sequence at this place, a relaxed update goes on with it.
    if (access == AtomicAccess::store && handed_over != none) clocks_.clear(handed_over);
    return;
  }
  if (handed_over == none) handed_over = find_or_add(key);
  if (access == AtomicAccess::store) {
    clocks_.copy(handed_over, hands_over);
  } else {
    clocks_.join(handed_over, hands_over);
  }
  if (hands_over == self.now) tick(task);
}

HappensBefore::HandedOver HappensBefore::store_hands_over(TaskId task, int order, HandedOver continued) {
  const TaskClocks& self = tasks_[task];
  const Row hands_over = releases(order) ? self.now : self.fenced;
  if (hands_over == none && continued == none) return nothing;
  const Row row = clocks_.take();
  if (hands_over != none) clocks_.join(row, hands_over);
  if (continued != none) clocks_.join(row, continued);
  if (releases(order)) tick(task);
  return row;
}

void HappensBefore::receive(TaskClocks& task, Row handed_over, int order) {
  if (acquires(order)) {
    clocks_.join(task.now, handed_over);
    return;
  }
  if (task.received == none) task.received = clocks_.take();
  clocks_.join(task.received, handed_over);
}

void HappensBefore::fence(TaskId task, int order) {
  TaskClocks& self = tasks_[task];
  if (acquires(order) && self.received != none) clocks_.join(self.now, self.received);
  if (!releases(order)) return;
  if (self.fenced == none) self.fenced = clocks_.take();
  clocks_.copy(self.fenced, self.now);
  tick(task);
}

std::size_t HappensBefore::slot_of(std::uint64_t key) const noexcept {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (key * 0x9e3779b97f4a7c15U) >> (64 - std::countr_zero(slots_.size()));
  while (slots_[slot].generation == generation_ && slots_[slot].key != key) slot = (slot + 1) & mask;
  return slot;
}

HappensBefore::Row HappensBefore::find(SyncKey key) const noexcept {
  const Slot& slot = slots_[slot_of(key.value)];
  return slot.generation == generation_ ? slot.row : none;
}

HappensBefore::Row HappensBefore::find_or_add(SyncKey key) {
  Slot& slot = slots_[slot_of(key.value)];
  if (slot.generation == generation_) return slot.row;
  const Row row = clocks_.take();
  slot = {.key = key.value, .generation = generation_, .row = row};
  if (2 * ++slots_used_ >= slots_.size()) grow();
  return row;
}

void HappensBefore::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (slot.generation == generation_) slots_[slot_of(slot.key)] = slot;
  }
}

}  // namespace ltsim
