// The strategies by name.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

/// Names that make_strategy() knows, the default first.
[[nodiscard]] std::vector<std::string> strategy_names();

/// A new strategy that has learned nothing yet.
/// @param name  one of strategy_names()
[[nodiscard]] std::unique_ptr<Strategy> make_strategy(std::string_view name);

}  // namespace ltsim
