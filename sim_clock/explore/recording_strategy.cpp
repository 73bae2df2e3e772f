#include "sim_clock/explore/recording_strategy.hpp"

#include "sim_clock/world/world.hpp"

namespace ltsim {

std::size_t RecordingStrategy::choose_task(const TaskChoice& choice) noexcept {
  const std::size_t chosen = chooser_.choose_task(choice);
  if (chosen == 0) return chosen;
  Deviation deviation;
  deviation.anchor = anchors_.anchor();
  deviation.to_task = world_.scheduler().task(static_cast<TaskId>(choice.options[chosen])).name;
  deviations_.push_back(std::move(deviation));
  return chosen;
}

std::size_t RecordingStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  const std::size_t variant = chooser_.strike(kind, variants_count);
  if (variant == 0) return variant;
  Deviation deviation;
  deviation.kind = Deviation::Kind::fault;
  deviation.anchor = anchors_.anchor();
  deviation.fault = kind;
  if (kind == FaultKind::crash) {
    deviation.process = world_.process_name(world_.faults().crash_candidate(variant));
    make_one_word(deviation.process);
  } else {
    deviation.answer = variant;
  }
  deviations_.push_back(std::move(deviation));
  return variant;
}

std::size_t RecordingStrategy::answer(std::size_t count) noexcept {
  const std::size_t answered = chooser_.answer(count);
  if (answered == 0) return answered;
  Deviation deviation;
  deviation.kind = Deviation::Kind::choose;
  deviation.anchor = anchors_.anchor();
  deviation.answer = answered;
  deviations_.push_back(std::move(deviation));
  return answered;
}

std::size_t RecordingStrategy::choose_age(const AgeChoice& choice) noexcept {
  const std::size_t chosen = chooser_.choose_age(choice);
  if (chosen == 0) return chosen;
  Deviation deviation;
  deviation.kind = Deviation::Kind::older;
  deviation.anchor = anchors_.anchor();
  deviation.answer = choice.ages[chosen];
  deviations_.push_back(std::move(deviation));
  return chosen;
}

SlowMoment RecordingStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  const SlowMoment moment = chooser_.slow_moment(choice);
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
