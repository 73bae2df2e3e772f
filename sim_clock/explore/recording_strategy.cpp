#include "sim_clock/explore/recording_strategy.hpp"

#include "sim_clock/world/world.hpp"

namespace ltsim {

std::size_t RecordingStrategy::choose(ChoiceKind kind, std::span<const std::uint64_t> options) noexcept {
  const std::size_t chosen = chooser_.choose(kind, options);
  if (chosen == 0) return chosen;
  Deviation deviation;
  deviation.anchor = anchors_.anchor();
  if (kind == ChoiceKind::task) {
    deviation.to_task = world_.scheduler().task(static_cast<TaskId>(options[chosen])).name;
  } else {
    deviation.kind = Deviation::Kind::choose;
    deviation.answer = chosen;
  }
  deviations_.push_back(std::move(deviation));
  return chosen;
}

SlowMoment RecordingStrategy::slow_moment(SimTime until_next_timer) noexcept {
  const SlowMoment moment = chooser_.slow_moment(until_next_timer);
  if (moment.duration != SimTime{0}) {
    Deviation deviation;
    deviation.kind = moment.others_go_on ? Deviation::Kind::stall : Deviation::Kind::pass_time;
    deviation.anchor = anchors_.anchor();
    deviation.passes = moment.duration;
    deviations_.push_back(std::move(deviation));
  }
  return moment;
}

}  // namespace ltsim
