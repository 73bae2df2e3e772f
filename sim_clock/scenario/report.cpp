#include "sim_clock/scenario/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sim_clock/explore/duration_text.hpp"

namespace ltsim {

std::string describe(const Failure& failure, std::string_view strategy) {
  const std::size_t lines = failure.schedule.deviations.size();
  const std::string minimized = lines == failure.choices_count ? "" : fmt::format(", minimized to {}", lines);
  std::string text = fmt::format(
      "{}  {}: {}\n  execution {}, seed {:#x}, strategy {}; {} choices that differ from the default{}, at "
      "{}\n",
      failure.schedule.scenario, to_string(failure.outcome.kind), failure.outcome.message, failure.execution,
      failure.seed, strategy, failure.choices_count, minimized, to_text(failure.at));
  for (const Deviation& deviation : failure.schedule.deviations)
    text += fmt::format("    {}\n", to_string(deviation));
  text += failure.story;
  if (failure.count > 1) text += fmt::format("  {} executions failed so\n", failure.count);
  return text;
}

std::string to_json(const JsonReport& report) {
  nlohmann::ordered_json failures = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < report.report.failures.size(); ++i) {
    const Failure& failure = report.report.failures[i];
    failures.push_back({{"kind", to_string(failure.outcome.kind)},
                        {"message", failure.outcome.message},
                        {"execution", failure.execution},
                        {"seed", failure.seed},
                        {"schedule", report.schedule_paths[i]}});
  }
  const nlohmann::ordered_json object{{"schema", "ltsim.explore/1"},
                                      {"scenario", report.scenario},
                                      {"strategy", report.strategy},
                                      {"seed", report.seed},
                                      {"executions", report.report.executions},
                                      {"decisions", report.report.decisions},
                                      {"seconds", report.report.seconds},
                                      {"distinct_schedules", report.report.distinct_schedules},
                                      {"failures", std::move(failures)}};
  // Messages may quote bytes of the code under test: what is not UTF-8 is replaced, never refused.
  return object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace ltsim
