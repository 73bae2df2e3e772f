// Watches a replay for time that passes although tasks could run, and where those tasks stood that were held up.
#pragma once

#include <string>
#include <vector>

#include "sim_clock/explore/anchor_tracker.hpp"
#include "sim_clock/explore/replay_strategy.hpp"
#include "sim_clock/explore/task_set.hpp"

namespace ltsim {

class SilenceWatch final : public Strategy {
 public:
  /// Slow moments of the whole machine, one after the other, in which the same tasks stood at the same places.
  struct Silence {
    std::vector<std::string> held_up_at;  ///< anchors
    std::size_t moments_count = 0;
    SimTime passed{0};
    SimTime shortest{0};  ///< of the moments

    template <typename Carrier>
    friend void carry(Carrier& carrier, Silence& silence) {
      carrier(silence.held_up_at, silence.moments_count, silence.passed, silence.shortest);
    }
  };

  SilenceWatch(ReplayStrategy& replay, const AnchorTracker& anchors) : replay_(replay), anchors_(anchors) {}

  [[nodiscard]] const std::vector<Silence>& silences() const noexcept { return silences_; }

  [[nodiscard]] std::string_view name() const noexcept override { return replay_.name(); }
  void begin_execution(std::uint64_t seed) noexcept override { replay_.begin_execution(seed); }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override {
    return replay_.choose_task(choice);
  }
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override {
    const SlowMoment moment = replay_.slow_moment(choice);
    if (moment.duration != SimTime{0} && !moment.others_go_on) add(moment.duration, choice);
    return moment;
  }
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override {
    return replay_.strike(kind, variants_count);
  }
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override { return replay_.answer(count); }
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override {
    return replay_.choose_age(choice);
  }

 private:
  void add(SimTime duration, const SlowMomentChoice& choice) {
    std::vector<std::string> places;
    for_each_task(choice.runnable, [&](TaskId task) {
      if (!anchors_.arrived_at(task).empty()) places.push_back(anchors_.arrived_at(task));
    });
    if (silences_.empty() || silences_.back().held_up_at != places)
      silences_.push_back({.held_up_at = std::move(places), .shortest = duration});
    Silence& last = silences_.back();
    ++last.moments_count;
    last.passed += duration;
    last.shortest = std::min(last.shortest, duration);
  }

  ReplayStrategy& replay_;
  const AnchorTracker& anchors_;
  std::vector<Silence> silences_;
};

}  // namespace ltsim
