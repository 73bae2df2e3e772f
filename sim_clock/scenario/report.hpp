// How an exploration is told: as text for a person, as JSON for a program.
#pragma once

#include <string>
#include <string_view>

#include "sim_clock/explore/explorer.hpp"

namespace ltsim {

/// The failure as a person wants it: what broke, and the choices that lead to it.
[[nodiscard]] std::string describe(const Failure& failure, std::string_view strategy);

struct JsonReport {
  std::string_view scenario;
  std::string_view strategy;
  std::uint64_t seed;
  const ExploreReport& report;
  const std::vector<std::string>& schedule_paths;  ///< one for each failure
};

/// One object, schema "ltsim.explore/1".
[[nodiscard]] std::string to_json(const JsonReport& report);

}  // namespace ltsim
