#include "kernel_mocks/run_watch.hpp"

namespace kernel_mocks {

RunWatch::RunWatch(LogicTask& logic_task, GeometryTask& geometry, Notifier& notifier,
                   const RunnerOptions& options)
    : logic_task_{logic_task},
      geometry_{geometry},
      notifier_{notifier},
      options_{options},
      optional_stop_{options.optional_stop} {}

RunStep RunWatch::begin_block(const Block& block) {
  if (options_.operator_ != nullptr && block.number) {
    options_.operator_->block_begun(*block.number, *options_.panel);
  }
  if (auto done = look(place_of(block)); !done) return done;
  return wait_for_cycle_start(block, held_, "feed hold");
}

RunStep RunWatch::wait_at_stop(const Block& block) {
  if (options_.continue_at_stop) return {};
  stopped_ = true;
  return wait_for_cycle_start(block, stopped_, "program stop");
}

RunStep RunWatch::wait_for_cycle_start(const Block& block, const bool& waiting, const char* why) {
  auto done = wait_watching(
      place_of(block), [&] { return !waiting || !is_attended(); }, [](std::byte) { return false; });
  if (!done) return done;
  if (waiting) return tl::unexpected{stopped_at(place_of(block), why)};
  return {};
}

RunStep RunWatch::look(const std::string& where) {
  if (logic_task_.interrupted()) return tl::unexpected{failed_at(where, {.fault = LogicFault::interrupted})};
  if (options_.panel == nullptr) return {};
  if (options_.operator_ != nullptr) {
    options_.operator_->look(std::chrono::steady_clock::now() - begun_, *options_.panel);
  }
  while (const auto event = options_.panel->take()) {
    if (auto done = obey(where, *event); !done) return done;
  }
  return {};
}

RunStep RunWatch::obey(const std::string& where, OperatorEvent event) {
  const auto ends_with = [&](LogicFault fault) { return tl::unexpected{failed_at(where, {.fault = fault})}; };
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
      return as_step(where, logic_task_.set_plc_running(event == OperatorEvent::plc_run));
    case OperatorEvent::optional_stop_on:
    case OperatorEvent::optional_stop_off:
      optional_stop_ = event == OperatorEvent::optional_stop_on;
      return {};
  }
  return {};
}

RunStep RunWatch::set_held(const std::string& where, bool held) {
  if (held == held_) return {};
  held_ = held;
  // The axes first, then the signal: M106 says that they are held.
  if (held && geometry_.is_moving()) geometry_.set_held(true);
  return as_step(where, logic_task_.set_feed_hold(held));
}

bool RunWatch::is_attended() const {
  return options_.panel != nullptr && (options_.operator_ == nullptr || !options_.operator_->has_left());
}

}  // namespace kernel_mocks
