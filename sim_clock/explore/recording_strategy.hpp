// Writes down what another strategy chooses, as the deviations of a schedule.
#pragma once

#include <vector>

#include "sim_clock/explore/anchor_tracker.hpp"
#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class RecordingStrategy final : public Strategy {
 public:
  /// @param anchors  must be the listener of the same execution
  RecordingStrategy(Strategy& chooser, const World& world, const AnchorTracker& anchors)
      : chooser_(chooser), world_(world), anchors_(anchors) {}

  [[nodiscard]] std::string_view name() const noexcept override { return chooser_.name(); }
  void begin_execution(std::uint64_t seed) noexcept override { chooser_.begin_execution(seed); }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;
  // What is recorded is the execution that the chooser has without it: but for telling states apart, which would let go of this one as
  // one that was seen.
  [[nodiscard]] bool points_cost_time() const noexcept override { return chooser_.points_cost_time(); }
  [[nodiscard]] bool passes_uncontended() const noexcept override { return chooser_.passes_uncontended(); }
  [[nodiscard]] bool follows_steps() const noexcept override { return chooser_.follows_steps(); }
  void performs(TaskId task, const Operation& operation) noexcept override {
    chooser_.performs(task, operation);
  }
  void resumes(TaskId task, const Operation& operation) noexcept override {
    chooser_.resumes(task, operation);
  }
  void only_looked() noexcept override { chooser_.only_looked(); }

  [[nodiscard]] const std::vector<Deviation>& deviations() const noexcept { return deviations_; }

 private:
  Strategy& chooser_;
  const World& world_;
  const AnchorTracker& anchors_;
  std::vector<Deviation> deviations_;
};

}  // namespace ltsim
