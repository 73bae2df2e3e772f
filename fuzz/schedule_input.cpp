#include "fuzz/schedule_input.hpp"

#include "sim_clock/explore/schedule.hpp"

namespace fuzz {

std::optional<std::string> input_of(std::string_view text) {
  const auto schedule = ltsim::parse_schedule(text);
  if (!schedule) return std::nullopt;
  std::string input;
  for (const std::string& record : schedule->input) input += record;
  return input;
}

}  // namespace fuzz
