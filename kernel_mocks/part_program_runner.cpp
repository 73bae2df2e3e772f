#include "kernel_mocks/part_program_runner.hpp"

#include <utility>

#include <fmt/format.h>

#include "kernel_mocks/plc_signals.hpp"

namespace kernel_mocks {
namespace {

std::string place_of(const Block& block) {
  return block.number ? fmt::format("block N{} (line {})", *block.number, block.line)
                      : fmt::format("line {}", block.line);
}

std::string place_of(const Block& block, const FunctionRequest& request) {
  return fmt::format("{}, {}", place_of(block), to_string(request));
}

RunResult failed(const std::string& where, const LogicFailure& failure) {
  return {.outcome = RunOutcome::failed,
          .message = fmt::format("{}: {}", where, to_string(failure)),
          .failure = failure};
}

tl::unexpected<RunResult> stopped(const Block& block, const char* why) {
  return tl::unexpected{RunResult{
      .outcome = RunOutcome::stopped, .message = fmt::format("{}: {}", place_of(block), why), .failure = {}}};
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
  at_tool_change_position_.reset();
  optional_stop_ = options_.optional_stop;
  held_ = stopped_ = spindle_has_started_ = false;
  begun_ = std::chrono::steady_clock::now();

  RunResult result;
  if (const auto begun = logic_task_.begin_program(); !begun) {
    result = failed("program start", begun.error());
  } else {
    if (observer_ != nullptr) observer_->program_begun(std::chrono::steady_clock::now());
    tasks_.emplace(logic_task_);
    result = run_blocks(program);
    // The threads end first: what they have begun must not come after the reset.
    tasks_->functions.stop();
    abandon_pending(result);
    tasks_.reset();
    if (result.outcome == RunOutcome::ended) {
      if (const auto ended = logic_task_.end_program(); !ended) result = failed("program end", ended.error());
    }
  }
  if (result.outcome != RunOutcome::ended) {
    logic_task_.reset();
    if (held_) (void)logic_task_.set_feed_hold(false);
  }
  return result;
}

RunResult PartProgramRunner::run_blocks(const Program& program) {
  if (auto done = set_at_tool_change_position("program start", options_.axes.tool_change_z <= 0); !done) {
    return done.error();
  }
  for (const Block& block : program.blocks) {
    if (options_.operator_ != nullptr && block.number) {
      options_.operator_->block_begun(*block.number, *options_.panel);
    }
    if (auto done = look_at_panel(place_of(block)); !done) return done.error();
    if (auto done = wait_while_held(block); !done) return done.error();
    const auto flow = run_block(block);
    if (!flow) return flow.error();
    if (*flow == ProgramFlow::end) break;
    if (*flow != ProgramFlow::stop) continue;
    if (auto done = wait_at_stop(block); !done) return done.error();
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
  const bool passes_optional_stop = plan->flow == ProgramFlow::optional_stop && !optional_stop_;
  for (const FunctionRequest& request : plan->end) {
    if (passes_optional_stop && request.m == std::uint16_t{1}) continue;
    if (const auto done = give(block, request); !done) return tl::unexpected{done.error()};
  }
  if (plan->flow != ProgramFlow::optional_stop) return plan->flow;
  return passes_optional_stop ? ProgramFlow::none : ProgramFlow::stop;
}

PartProgramRunner::Step PartProgramRunner::give(const Block& block, const FunctionRequest& request) {
  if (auto done = finish_pending(); !done) return done;
  FunctionWorker& functions = tasks_->functions;
  functions.give(request);
  pending_ = Pending{&block, request};
  const std::string where = place_of(block, request);
  if (auto done = wait_until(where, [&] { return functions.raised_at() || functions.is_done(); }); !done) {
    return done;
  }
  if (!functions.raised_at()) return finish_pending();
  if (observer_ != nullptr) observer_->given(block, request, *functions.raised_at());
  if (request.spindle != SpindleEffect::none) spindle_has_started_ = request.spindle == SpindleEffect::start;
  return finish_pending_if(Acknowledgement::before_going_on);
}

PartProgramRunner::Step PartProgramRunner::finish_pending_if(Acknowledgement acknowledgement) {
  if (!pending_ || pending_->request.acknowledgement != acknowledgement) return {};
  return finish_pending();
}

PartProgramRunner::Step PartProgramRunner::finish_pending() {
  if (!pending_) return {};
  const Pending pending = *pending_;
  const std::string where = place_of(*pending.block, pending.request);
  FunctionWorker& functions = tasks_->functions;
  if (auto done = wait_until(where, [&] { return functions.is_done(); }); !done) return done;
  pending_.reset();
  const auto duration = functions.take_result();
  if (!duration) {
    if (observer_ != nullptr && functions.raised_at()) {
      observer_->not_acknowledged(*pending.block, pending.request, duration.error());
    }
    return tl::unexpected{failed(where, duration.error())};
  }
  if (observer_ != nullptr) observer_->acknowledged(*pending.block, pending.request, *duration);
  return {};
}

/// Its thread has stopped.
void PartProgramRunner::abandon_pending(const RunResult& why) {
  if (!pending_) return;
  const Pending pending = *std::exchange(pending_, std::nullopt);
  FunctionWorker& functions = tasks_->functions;
  if (observer_ == nullptr || !functions.raised_at()) return;
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

PartProgramRunner::Step PartProgramRunner::move(const Block& block, const Motion& motion) {
  if (motion.kind == MotionKind::feed) {
    if (auto done = finish_pending_if(Acknowledgement::before_feed); !done) return done;
    if (auto done = wait_for_spindle(block); !done) return done;
  }
  const auto begun = std::chrono::steady_clock::now();
  auto done = carry_out(block, motion);
  if (observer_ != nullptr) {
    const bool in_no_time = motion.duration == std::chrono::nanoseconds{0};
    observer_->moved(block, motion.kind,
                     in_no_time ? motion.duration : std::chrono::steady_clock::now() - begun,
                     done.has_value());
  }
  return done;
}

PartProgramRunner::Step PartProgramRunner::carry_out(const Block& block, const Motion& motion) {
  const std::string where = place_of(block);
  const bool arrives_at_tool_change = motion.z >= options_.axes.tool_change_z;
  if (motion.duration == std::chrono::nanoseconds{0}) {
    return set_at_tool_change_position(where, arrives_at_tool_change);
  }

  if (!arrives_at_tool_change) {
    if (auto done = set_at_tool_change_position(where, false); !done) return done;
  }
  if (auto done = check(where, logic_task_.set_motion_under_way(true)); !done) return done;
  GeometryTask& geometry = tasks_->geometry;
  geometry.set_held(true);
  geometry.start(motion.duration);
  std::optional<RunResult> failure;
  if (auto done = wait_until(where,
                             [&] {
                               if (!geometry.is_moving()) return true;
                               const auto status = logic_task_.healthy_status();
                               if (!status) {
                                 failure = failed(where, status.error());
                                 return true;
                               }
                               const bool enabled = (*status & signals::feed_enable) != std::byte{0};
                               geometry.set_held(motion.kind != MotionKind::dwell && (held_ || !enabled));
                               return false;
                             });
      !done) {
    return done;
  }
  if (failure) return tl::unexpected{*failure};
  if (auto done = check(where, logic_task_.set_motion_under_way(false)); !done) return done;
  return set_at_tool_change_position(where, arrives_at_tool_change);
}

PartProgramRunner::Step PartProgramRunner::wait_for_spindle(const Block& block) {
  if (!spindle_has_started_) return {};
  const std::string where = place_of(block);
  const auto since = std::chrono::steady_clock::now();
  std::optional<RunResult> failure;
  auto done = wait_until(where, [&] {
    const auto status = logic_task_.healthy_status();
    if (!status) {
      failure = failed(where, status.error());
      return true;
    }
    if ((*status & signals::spindle_at_speed) != std::byte{0}) return true;
    const std::chrono::nanoseconds waited = std::chrono::steady_clock::now() - since;
    if (waited < options_.spindle_timeout) return false;
    failure = failed(where, {.fault = LogicFault::spindle_not_at_speed, .after = waited});
    return true;
  });
  if (!done) return done;
  if (failure) return tl::unexpected{*failure};
  // Once after each start: what the speed does later is the PLC's alarm.
  spindle_has_started_ = false;
  return {};
}

PartProgramRunner::Step PartProgramRunner::wait_at_stop(const Block& block) {
  if (options_.continue_at_stop) return {};
  stopped_ = true;
  auto done = wait_until(place_of(block), [&] { return !stopped_ || !is_attended(); });
  if (!done) return done;
  if (stopped_) return stopped(block, "program stop");
  return {};
}

PartProgramRunner::Step PartProgramRunner::wait_while_held(const Block& block) {
  if (!held_) return {};
  auto done = wait_until(place_of(block), [&] { return !held_ || !is_attended(); });
  if (!done) return done;
  if (held_) return stopped(block, "feed hold");
  return {};
}

PartProgramRunner::Step PartProgramRunner::set_held(const std::string& where, bool held) {
  if (held == held_) return {};
  held_ = held;
  // The axes first, then the signal: M106 says that they are held.
  if (held && tasks_->geometry.is_moving()) tasks_->geometry.set_held(true);
  return check(where, logic_task_.set_feed_hold(held));
}

PartProgramRunner::Step PartProgramRunner::set_at_tool_change_position(const std::string& where, bool there) {
  if (at_tool_change_position_ == there) return {};
  at_tool_change_position_ = there;
  return check(where, logic_task_.set_at_tool_change_position(there));
}

template <typename Ready>
PartProgramRunner::Step PartProgramRunner::wait_until(const std::string& where, Ready ready) {
  while (!ready()) {
    if (logic_task_.interrupted()) return tl::unexpected{failed(where, {.fault = LogicFault::interrupted})};
    if (auto done = look_at_panel(where); !done) return done;
    tasks_->notifier.wait_for(logic_task_.options().poll_interval);
  }
  return {};
}

PartProgramRunner::Step PartProgramRunner::look_at_panel(const std::string& where) {
  if (options_.panel == nullptr) return {};
  if (options_.operator_ != nullptr) {
    options_.operator_->look(std::chrono::steady_clock::now() - begun_, *options_.panel);
  }
  while (const auto event = options_.panel->take()) {
    if (auto done = obey(where, *event); !done) return done;
  }
  return {};
}

PartProgramRunner::Step PartProgramRunner::obey(const std::string& where, OperatorEvent event) {
  const auto ends_with = [&](LogicFault fault) { return tl::unexpected{failed(where, {.fault = fault})}; };
  switch (event) {
    case OperatorEvent::cycle_start:
      stopped_ = false;
      return set_held(where, false);
    case OperatorEvent::feed_hold:
      return set_held(where, true);
    case OperatorEvent::reset:
      return ends_with(LogicFault::operator_reset);
    case OperatorEvent::abort:
      return ends_with(LogicFault::operator_abort);
    case OperatorEvent::emergency_stop:
      return ends_with(LogicFault::operator_emergency_stop);
    case OperatorEvent::plc_run:
    case OperatorEvent::plc_stop:
      return check(where, logic_task_.set_plc_running(event == OperatorEvent::plc_run));
    case OperatorEvent::optional_stop_on:
    case OperatorEvent::optional_stop_off:
      optional_stop_ = event == OperatorEvent::optional_stop_on;
      return {};
  }
  return {};
}

bool PartProgramRunner::is_attended() const {
  return options_.panel != nullptr && (options_.operator_ == nullptr || !options_.operator_->has_left());
}

PartProgramRunner::Step PartProgramRunner::check(const std::string& where,
                                                 const tl::expected<void, LogicFailure>& done) const {
  if (!done) return tl::unexpected{failed(where, done.error())};
  return {};
}

}  // namespace kernel_mocks
