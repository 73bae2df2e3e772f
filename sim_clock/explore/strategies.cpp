#include "sim_clock/explore/strategies.hpp"

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/explore/memory_across_forks.hpp"
#include "sim_clock/explore/swarm_strategy.hpp"

namespace ltsim {

void* Strategy::operator new(std::size_t bytes) { return new_shared_memory(bytes); }

void Strategy::operator delete(void* strategy, std::size_t bytes) noexcept {
  delete_shared_memory(strategy, bytes);
}

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
