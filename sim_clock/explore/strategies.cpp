#include "sim_clock/explore/strategies.hpp"

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"

namespace ltsim {

std::vector<std::string> strategy_names() { return {"swarm", "random", "pct", "pos", "surw", "stall"}; }

std::unique_ptr<Strategy> make_strategy(std::string_view name) {
  if (name == "random") return std::make_unique<RandomStrategy>();
  if (name == "pct") return std::make_unique<PctStrategy>();
  if (name == "pos") return std::make_unique<PosStrategy>();
  if (name == "surw") return std::make_unique<SurwStrategy>();
  if (name == "stall") return std::make_unique<StallStrategy>();
  if (name == "swarm") return std::make_unique<SwarmStrategy>();
  LTSIM_UNREACHABLE("a strategy that strategy_names() does not list");
}

}  // namespace ltsim
