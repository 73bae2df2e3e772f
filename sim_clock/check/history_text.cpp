#include "sim_clock/check/history_text.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/check/linearizability.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

std::string history_text(std::span<const HistoryLine> lines) {
  constexpr std::size_t lines_max = 20;  // a screen, with what else is printed of a failure
  const std::size_t hidden = lines.size() - std::min(lines.size(), lines_max);
  const auto shown = lines.subspan(hidden);
  std::vector<std::uint32_t> events;
  std::size_t name_width = 0;
  for (const HistoryLine& line : shown) {
    events.push_back(line.called_at);
    if (line.returned_at != OperationInterval::never) events.push_back(line.returned_at);
    name_width = std::max(name_width, line.task.size());
  }
  std::sort(events.begin(), events.end());
  const auto number = [&](std::uint32_t event) {
    return std::lower_bound(events.begin(), events.end(), event) - events.begin() + 1;
  };
  std::string text;
  if (hidden != 0) text += fmt::format("\n  ({} earlier operations)", hidden);
  for (const HistoryLine& line : shown) {
    const bool returned = line.returned_at != OperationInterval::never;
    text += fmt::format("\n  {:>2} to {:<2}  {:<{}}  {}", number(line.called_at),
                        returned ? fmt::to_string(number(line.returned_at)) : "?", line.task, name_width,
                        line.text);
  }
  return text;
}

std::string running_task_name() { return current_task == nullptr ? "scenario" : current_task->name; }

}  // namespace ltsim
