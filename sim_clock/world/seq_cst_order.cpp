#include "sim_clock/world/seq_cst_order.hpp"

namespace ltsim {

void SeqCstOrder::shorten() noexcept {
  constexpr std::size_t retired = events_max / 2 - 1;  // with the past they make the new past
  for (std::size_t i = 1; i + retired < count_; ++i) {
    before_[i] = shortened(before_[i + retired]);
    ticks_[i] = ticks_[i + retired];
    tasks_[i] = tasks_[i + retired];
  }
  // That the past is a fence, too, costs nothing but orders: it is not told apart.
  fences_ = shortened(fences_);
  count_ -= retired;
}

SeqCstOrder::Events SeqCstOrder::before_next_of(TaskId task, const Ticks* known) const noexcept {
  Events before = 1;
  for (std::size_t i = count_ - 1; i > 0; --i) {
    const Events event = Events{1} << i;
    if ((before & event) != 0) continue;
    if (tasks_[i] == task || ticks_[i].strongly_happens <= known[tasks_[i]]) before |= event | before_[i];
  }
  return before;
}

SeqCstOrder::Events SeqCstOrder::fences_before(TaskId task, const Ticks* known,
                                               const Ticks* more) const noexcept {
  Events found = fences_ & 1;
  for (Events fences = fences_ & ~Events{1}; fences != 0; fences &= fences - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(fences));
    const TaskId of = tasks_[i];
    if (of == task || ticks_[i].happens <= known[of] || (more != nullptr && ticks_[i].happens <= more[of]))
      found |= Events{1} << i;
  }
  return found;
}

SeqCstOrder::Events SeqCstOrder::add(TaskId task, Ticked ticks, bool is_fence, Events before) noexcept {
  const std::size_t i = count_++;
  const Events event = Events{1} << i;
  before_[i] = before;
  ticks_[i] = ticks;
  tasks_[i] = task;
  if (is_fence) fences_ |= event;
  return event;
}

void SeqCstOrder::put_before(Events earlier, Events later) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (((before_[i] | Events{1} << i) & later) != 0) before_[i] |= earlier;
  }
}

}  // namespace ltsim
