#include "kernel_mocks/part_program_runner.hpp"

#include <utility>

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

std::string place_of(const Block& block, const FunctionRequest& request) {
  return fmt::format("{}, {}", place_of(block), to_string(request));
}

}  // namespace

PartProgramRunner::PartProgramRunner(LogicTask& logic_task, const RunnerOptions& options,
                                     PartProgramObserver* observer)
    : logic_task_{logic_task}, options_{options}, observer_{observer} {}

RunResult PartProgramRunner::run(const Program& program) {
  if (const auto checked = check_for_machine(program, *options_.machine_table); !checked) {
    return {.outcome = RunOutcome::refused, .message = to_string(checked.error()), .failure = {}};
  }
  if (const auto checked = check_motion(program, options_.axes); !checked) {
    return {.outcome = RunOutcome::refused, .message = to_string(checked.error()), .failure = {}};
  }
  pending_.reset();
  planner_.emplace(options_.axes);

  RunResult result;
  bool held = false;
  if (const auto begun = logic_task_.begin_program(); !begun) {
    result = failed_at("program start", begun.error());
  } else {
    if (observer_ != nullptr) observer_->program_begun(std::chrono::steady_clock::now());
    tasks_.emplace(logic_task_, options_);
    result = run_blocks(program);
    // The threads end first: what they have begun must not come after the reset.
    tasks_->functions.stop();
    abandon_pending(result);
    held = tasks_->watch.is_held();
    tasks_.reset();
    if (result.outcome == RunOutcome::ended) {
      if (const auto ended = logic_task_.end_program(); !ended)
        result = failed_at("program end", ended.error());
    }
  }
  if (result.outcome != RunOutcome::ended) {
    logic_task_.reset();
    if (held) (void)logic_task_.set_feed_hold(false);
  }
  return result;
}

RunResult PartProgramRunner::run_blocks(const Program& program) {
  if (auto done = tasks_->axes.begin_program(); !done) return done.error();
  for (const Block& block : program.blocks) {
    if (auto done = tasks_->watch.begin_block(block); !done) return done.error();
    const auto flow = run_block(block);
    if (!flow) return flow.error();
    if (*flow == ProgramFlow::end) break;
    if (*flow != ProgramFlow::stop) continue;
    if (auto done = tasks_->watch.wait_at_stop(block); !done) return done.error();
    if (observer_ != nullptr) observer_->stop_passed(block);
  }
  if (const auto done = finish_pending(); !done) return done.error();
  return {};
}

/// @return ProgramFlow::none, stop or end; whether M1 stops is decided here
tl::expected<ProgramFlow, RunResult> PartProgramRunner::run_block(const Block& block) {
  const auto plan = plan_block(block, *options_.machine_table);
  const auto motion = planner_->plan(block);
  if (!plan || !motion) {  // run() has planned every block before the first one ran
    return tl::unexpected{
        RunResult{RunOutcome::refused, to_string(plan ? motion.error() : plan.error()), {}}};
  }
  for (const FunctionRequest& request : plan->begin) {
    if (const auto done = give(block, request); !done) return tl::unexpected{done.error()};
  }
  if (*motion) {
    if (const auto done = move(block, **motion); !done) return tl::unexpected{done.error()};
  }
  if (const auto done = finish_pending_if(Acknowledgement::at_block_end); !done) {
    return tl::unexpected{done.error()};
  }
  const bool passes_optional_stop =
      plan->flow == ProgramFlow::optional_stop && !tasks_->watch.optional_stop();
  for (const FunctionRequest& request : plan->end) {
    if (passes_optional_stop && request.m == std::uint16_t{1}) continue;
    if (const auto done = give(block, request); !done) return tl::unexpected{done.error()};
  }
  if (plan->flow != ProgramFlow::optional_stop) return plan->flow;
  return passes_optional_stop ? ProgramFlow::none : ProgramFlow::stop;
}

RunStep PartProgramRunner::give(const Block& block, const FunctionRequest& request) {
  if (auto done = finish_pending(); !done) return done;
  FunctionWorker& functions = tasks_->functions;
  functions.give(request);
  pending_ = Pending{&block, request, false};
  const std::string where = place_of(block, request);
  if (auto done =
          tasks_->watch.wait_until(where, [&] { return functions.raised_at() || functions.is_done(); });
      !done) {
    return done;
  }
  if (!functions.raised_at()) return finish_pending();
  tell_given();
  tasks_->axes.spindle_given(request.spindle);
  return finish_pending_if(Acknowledgement::before_going_on);
}

void PartProgramRunner::tell_given() {
  const auto raised_at = tasks_->functions.raised_at();
  if (!raised_at || std::exchange(pending_->told, true) || observer_ == nullptr) return;
  observer_->given(*pending_->block, pending_->request, *raised_at);
}

RunStep PartProgramRunner::finish_pending_if(Acknowledgement acknowledgement) {
  if (!pending_ || pending_->request.acknowledgement != acknowledgement) return {};
  return finish_pending();
}

RunStep PartProgramRunner::finish_pending() {
  if (!pending_) return {};
  const Pending pending = *pending_;
  const std::string where = place_of(*pending.block, pending.request);
  FunctionWorker& functions = tasks_->functions;
  if (auto done = tasks_->watch.wait_until(where, [&] { return functions.is_done(); }); !done) return done;
  pending_.reset();
  const auto duration = functions.take_result();
  if (!duration) {
    if (observer_ != nullptr && pending.told) {
      observer_->not_acknowledged(*pending.block, pending.request, duration.error());
    }
    return tl::unexpected{failed_at(where, duration.error())};
  }
  if (observer_ != nullptr) observer_->acknowledged(*pending.block, pending.request, *duration);
  return {};
}

/// Its thread has stopped.
void PartProgramRunner::abandon_pending(const RunResult& why) {
  if (!pending_) return;
  tell_given();
  const Pending pending = *std::exchange(pending_, std::nullopt);
  FunctionWorker& functions = tasks_->functions;
  if (observer_ == nullptr || !pending.told) return;
  // It may have ended, unseen, before the run did.
  if (functions.is_done()) {
    if (const auto duration = functions.take_result()) {
      observer_->acknowledged(*pending.block, pending.request, *duration);
      return;
    }
  }
  observer_->not_acknowledged(*pending.block, pending.request,
                              why.failure.value_or(LogicFailure{.fault = LogicFault::interrupted}));
}

RunStep PartProgramRunner::move(const Block& block, const Motion& motion) {
  if (motion.kind == MotionKind::feed) {
    if (auto done = finish_pending_if(Acknowledgement::before_feed); !done) return done;
    if (auto done = tasks_->axes.wait_for_spindle(block); !done) return done;
  }
  const auto begun = std::chrono::steady_clock::now();
  auto done = tasks_->axes.move(block, motion);
  if (observer_ != nullptr) {
    const bool in_no_time = motion.duration == std::chrono::nanoseconds{0};
    observer_->moved(block, motion.kind,
                     in_no_time ? motion.duration : std::chrono::steady_clock::now() - begun,
                     done.has_value());
  }
  return done;
}

}  // namespace kernel_mocks
