#include "sim_clock/explore/anchor_tracker.hpp"

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

AnchorTracker::AnchorTracker(const World& world, StepListener* next) : world_(world), next_(next) {}

void AnchorTracker::arrives(const Task& task, const Operation& operation) noexcept {
  stand_at(
      fmt::format("{} before {} {}", task.name, to_string(operation.kind), world_.objects().name(operation)));
  if (arrived_at_.size() <= task.id) arrived_at_.resize(task.id + 1U);
  arrived_at_[task.id] = anchor_;
  if (next_ != nullptr) next_->arrives(task, operation);
}

void AnchorTracker::performs(const Task& task, const Operation& operation) noexcept {
  // Others may have run since it arrived. What is chosen now, a fault, is chosen where this task stands.
  anchor_ = arrived_at_[task.id];
  if (next_ != nullptr) next_->performs(task, operation);
}

void AnchorTracker::blocks(const Task& task) noexcept {
  stand_at(fmt::format("{} in {} {}", task.name, to_string(world_.scheduler().pending(task).kind),
                       world_.objects().name(world_.scheduler().pending(task))));
  if (next_ != nullptr) next_->blocks(task);
}

void AnchorTracker::held_up(const Task& task, SimTime duration) noexcept {
  // Who runs meanwhile is chosen while the task waits "in" its operation; what is chosen "before" it comes later.
  stand_at(fmt::format("{} in {} {}", task.name, to_string(world_.scheduler().pending(task).kind),
                       world_.objects().name(world_.scheduler().pending(task))));
  if (next_ != nullptr) next_->held_up(task, duration);
}

void AnchorTracker::goes_on(const Task& task) noexcept {
  anchor_ = arrived_at_[task.id];
  if (next_ != nullptr) next_->goes_on(task);
}

void AnchorTracker::ends(const Task& task) noexcept {
  anchor_ = fmt::format("{} end", task.name);
  if (next_ != nullptr) next_->ends(task);
}

void AnchorTracker::older(const Task& task, const OlderStore& taken) noexcept {
  if (next_ != nullptr) next_->older(task, taken);
}

void AnchorTracker::asks(const Task* task, std::string_view what) noexcept {
  stand_at(fmt::format("{} asks {}", task == nullptr ? "-" : task->name, what));
  if (next_ != nullptr) next_->asks(task, what);
}

void AnchorTracker::notes(std::string_view text) noexcept {
  if (next_ != nullptr) next_->notes(text);
}

void AnchorTracker::stand_at(const std::string& place) {
  anchor_ = fmt::format("{} #{}", place, ++visits_[place]);
}

}  // namespace ltsim
