// The fair tail of an execution that does not end (Scheduler::in_fair_tail()): what happens at its points beyond
// what happens at all others.

#include <algorithm>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "sim_clock/check/no_progress.hpp"
#include "sim_clock/explore/task_set.hpp"
#include "sim_clock/world/scheduler.hpp"

namespace ltsim {

void Scheduler::skip_time_if_all_give_way() noexcept {
  if (!clock_.any_armed()) return;
  bool all = true;
  for_each_task(runnable_, [&](TaskId id) {
    all = all &&
          (pending_[id].kind == OperationKind::yield || tasks_[id]->looks_count >= looks_before_giving_way);
  });
  if (!all) return;
  clock_.pass(std::max(clock_.next_deadline() - clock_.now(), SimTime{0}));
  wake_due();
}

void Scheduler::pass_fair_tail(Task& task, const Operation& operation) noexcept {
  if (points_ > points_max_) {
    const GhostScope ghost;
    fail(OutcomeKind::livelock,
         fmt::format("{} scheduling points and no end; {}", points_max_, describe_livelock(world_)));
  }
  clock_.pass(point_cost - point_cost_);  // also where points cost nothing a loop that polls a clock ends
  // Of all that a task does again and again the same one is kept, wherever in its loop the tail begins and ends.
  // Addresses outside of segments are no part of that: they differ from run to run.
  const auto keep_least = [&](std::optional<Operation>& kept) {
    const auto key = [](const Operation& of) {
      return std::tuple{of.object == 0, of.object, of.object == 0 ? 0 : of.offset, of.kind, of.bytes};
    };
    if (!kept || key(operation) < key(*kept)) kept = operation;
  };
  if (can_be_polling(operation.kind) || operation.kind == OperationKind::atomic_update) {
    keep_least(task.polls);
  } else if (changes_what_others_see(operation.kind)) {
    keep_least(task.repeats);
  }
}

}  // namespace ltsim
