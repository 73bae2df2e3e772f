#include "sim_clock/scenario/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sim_clock/explore/duration_text.hpp"

namespace ltsim {
namespace {

using nlohmann::ordered_json;

ordered_json to_object(const Failure& failure, const std::string& schedule_path) {
  ordered_json object{{"kind", to_string(failure.outcome.kind)},
                      {"message", failure.outcome.message},
                      {"execution", failure.execution},
                      {"seed", failure.seed},
                      {"schedule", nullptr}};
  if (!schedule_path.empty()) {
    object["schedule"] = schedule_path;
  } else if (failure.has_schedule) {
    object["schedule_text"] = to_string(failure.schedule);
  }
  return object;
}

ordered_json to_object(const ScenarioReport& report) {
  ordered_json failures = ordered_json::array();
  for (std::size_t i = 0; i < report.explored.failures.size(); ++i)
    failures.push_back(to_object(report.explored.failures[i], report.schedule_paths[i]));
  ordered_json object{{"schema", "ltsim.explore/1"},
                      {"scenario", report.scenario},
                      {"strategy", report.strategy},
                      {"seed", report.seed},
                      {"executions", report.explored.executions},
                      {"decisions", report.explored.decisions},
                      {"seconds", report.explored.seconds},
                      {"distinct_schedules", report.explored.distinct_schedules},
                      {"failures", std::move(failures)}};
  if (report.error) object["error"] = *report.error;
  return object;
}

}  // namespace

std::string describe(const Failure& failure, std::string_view strategy) {
  std::string text = fmt::format("{}  {}: {}\n  execution {}, seed {:#x}, strategy {}; ",
                                 failure.schedule.scenario, to_string(failure.outcome.kind),
                                 failure.outcome.message, failure.execution, failure.seed, strategy);
  if (failure.has_schedule) {
    const std::size_t lines = failure.schedule.deviations.size();
    text += fmt::format("{} choices that differ from the default{}, at {}\n", failure.choices_count,
                        lines == failure.choices_count ? "" : fmt::format(", minimized to {}", lines),
                        to_text(failure.at));
  } else {
    text += "its choices are lost with its process\n";
  }
  for (const Deviation& deviation : failure.schedule.deviations)
    text += fmt::format("    {}\n", to_string(deviation));
  text += failure.story;
  if (failure.count > 1) text += fmt::format("  {} executions failed so\n", failure.count);
  return text;
}

std::string to_json(const std::vector<ScenarioReport>& reports) {
  ordered_json all = ordered_json::array();
  for (const ScenarioReport& report : reports) all.push_back(to_object(report));
  // Messages may quote bytes of the code under test: what is not UTF-8 is replaced, never refused.
  return (all.size() == 1 ? all.front() : all).dump(2, ' ', false, ordered_json::error_handler_t::replace) +
         "\n";
}

}  // namespace ltsim
