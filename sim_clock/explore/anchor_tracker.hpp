// Names the place at which an execution stands, the same way each time that it stands there: the anchors of a
// schedule.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sim_clock/world/step_listener.hpp"

namespace ltsim {

class World;

class AnchorTracker final : public StepListener {
 public:
  /// @param next  is told everything too; may be null
  AnchorTracker(const World& world, StepListener* next);

  /// "kernel/main before sem_wait handoff #2"; "- start" before the first step.
  [[nodiscard]] const std::string& anchor() const noexcept { return anchor_; }

  /// Where the task stands before its latest step; "" if it has made none.
  [[nodiscard]] const std::string& arrived_at(TaskId task) const noexcept {
    static const std::string nowhere;
    return task < arrived_at_.size() ? arrived_at_[task] : nowhere;
  }

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
  void stand_at(const std::string& place);

  const World& world_;
  StepListener* next_;
  std::string anchor_ = "- start";
  std::unordered_map<std::string, unsigned> visits_;
  std::vector<std::string> arrived_at_;  // by task number: its anchor before its latest step
};

}  // namespace ltsim
