#include "kernel_mocks/part_program_runner.hpp"

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

std::string place_of(const Block& block) {
  return block.number ? fmt::format("block N{} (line {})", *block.number, block.line)
                      : fmt::format("line {}", block.line);
}

std::string place_of(const Block& block, const FunctionRequest& request) {
  return fmt::format("{}, {}", place_of(block), to_string(request));
}

}  // namespace

PartProgramRunner::PartProgramRunner(LogicTask& logic_task, const RunnerOptions& options,
                                     PartProgramObserver* observer)
    : logic_task_{logic_task}, options_{options}, observer_{observer} {}

RunResult PartProgramRunner::run(const Program& program) {
  if (const auto checked = check_for_machine(program); !checked) {
    return {.outcome = RunOutcome::refused, .message = to_string(checked.error()), .failure = {}};
  }
  pending_.reset();
  if (const auto begun = logic_task_.begin_program(); !begun) {
    return failed("program start", begun.error());
  }
  for (const Block& block : program.blocks) {
    const auto flow = run_block(block);
    if (!flow) return flow.error();
    if (*flow == ProgramFlow::end) break;
    if (*flow != ProgramFlow::stop) continue;
    if (!options_.continue_at_stop) {
      logic_task_.reset();
      return {.outcome = RunOutcome::stopped,
              .message = fmt::format("{}: program stop", place_of(block)),
              .failure = {}};
    }
    if (observer_ != nullptr) observer_->stop_passed(block);
  }
  if (const auto done = finish_pending(); !done) return done.error();
  if (const auto ended = logic_task_.end_program(); !ended) return failed("program end", ended.error());
  return {};
}

/// @return ProgramFlow::none, stop or end; whether M1 stops is decided here
tl::expected<ProgramFlow, RunResult> PartProgramRunner::run_block(const Block& block) {
  const auto plan = plan_block(block);
  if (!plan) {  // run() has planned every block before the first one ran
    return tl::unexpected{RunResult{RunOutcome::refused, to_string(plan.error()), {}}};
  }
  for (const FunctionRequest& request : plan->begin) {
    if (const auto done = give(block, request); !done) return tl::unexpected{done.error()};
  }
  if (plan->has_motion && observer_ != nullptr) observer_->motion_noted(block);
  const bool passes_optional_stop = plan->flow == ProgramFlow::optional_stop && !options_.optional_stop;
  for (const FunctionRequest& request : plan->end) {
    if (passes_optional_stop && request.m == std::uint16_t{1}) continue;
    if (const auto done = give(block, request); !done) return tl::unexpected{done.error()};
  }
  if (plan->flow != ProgramFlow::optional_stop) return plan->flow;
  return options_.optional_stop ? ProgramFlow::stop : ProgramFlow::none;
}

tl::expected<void, RunResult> PartProgramRunner::give(const Block& block, const FunctionRequest& request) {
  if (auto done = finish_pending(); !done) return done;
  if (const auto raised = logic_task_.raise(request); !raised) {
    return tl::unexpected{failed(place_of(block, request), raised.error())};
  }
  pending_ = Pending{&block, request};
  if (request.acknowledgement == Acknowledgement::before_next_function) return {};
  return finish_pending();
}

tl::expected<void, RunResult> PartProgramRunner::finish_pending() {
  if (!pending_) return {};
  const Pending pending = *pending_;
  pending_.reset();
  const auto duration = logic_task_.acknowledge();
  if (!duration) return tl::unexpected{failed(place_of(*pending.block, pending.request), duration.error())};
  if (observer_ != nullptr) observer_->acknowledged(*pending.block, pending.request, *duration);
  return {};
}

RunResult PartProgramRunner::failed(const std::string& where, const LogicFailure& failure) {
  logic_task_.reset();
  return {.outcome = RunOutcome::failed,
          .message = fmt::format("{}: {}", where, to_string(failure)),
          .failure = failure};
}

}  // namespace kernel_mocks
