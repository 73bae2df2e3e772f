#include "kernel_mocks/operator_panel.hpp"

#include <algorithm>

namespace kernel_mocks {

std::string_view to_string(OperatorEvent event) noexcept {
  switch (event) {
    case OperatorEvent::cycle_start:
      return "cycle-start";
    case OperatorEvent::feed_hold:
      return "feed-hold";
    case OperatorEvent::reset:
      return "reset";
    case OperatorEvent::abort:
      return "abort";
    case OperatorEvent::emergency_stop:
      return "emergency-stop";
    case OperatorEvent::plc_run:
      return "plc-run";
    case OperatorEvent::plc_stop:
      return "plc-stop";
    case OperatorEvent::optional_stop_on:
      return "optional-stop-on";
    case OperatorEvent::optional_stop_off:
      return "optional-stop-off";
  }
  return "unknown event";
}

void OperatorPanel::press(OperatorEvent event) {
  const std::scoped_lock lock{mutex_};
  events_.push_back(event);
}

std::optional<OperatorEvent> OperatorPanel::take() {
  const std::scoped_lock lock{mutex_};
  if (events_.empty()) return std::nullopt;
  const OperatorEvent event = events_.front();
  events_.pop_front();
  return event;
}

void ScriptedOperator::look(std::chrono::nanoseconds elapsed, OperatorPanel& panel) {
  std::erase_if(script_, [&](const OperatorScriptEntry& entry) {
    const auto* const time = std::get_if<std::chrono::nanoseconds>(&entry.when);
    if (time == nullptr || *time > elapsed) return false;
    panel.press(entry.event);
    return true;
  });
}

void ScriptedOperator::block_begun(std::uint32_t number, OperatorPanel& panel) {
  std::erase_if(script_, [&](const OperatorScriptEntry& entry) {
    if (entry.when != decltype(entry.when){number}) return false;
    panel.press(entry.event);
    return true;
  });
}

bool ScriptedOperator::has_left() const {
  return std::ranges::none_of(script_, [](const OperatorScriptEntry& entry) {
    return std::holds_alternative<std::chrono::nanoseconds>(entry.when);
  });
}

void RandomOperator::look(std::chrono::nanoseconds elapsed, OperatorPanel& panel) {
  if (elapsed < next_) return;
  next_ = elapsed + interval_;
  const auto choice = choose_(static_cast<std::uint32_t>(events_.size() + 1));
  panel.press(choice == 0 ? OperatorEvent::cycle_start : events_[choice - 1]);
}

}  // namespace kernel_mocks
