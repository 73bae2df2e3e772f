#include "sim_clock/world/random_numbers.hpp"

#include "sim_clock/world/state_hash.hpp"

namespace ltsim {

RandomNumbers::Generators& RandomNumbers::of_current() {
  auto& generators = generators_[current_task->process];
  if (generators == nullptr) {
    const GhostScope ghost;
    generators = std::make_unique<Generators>();
    initstate_r(1, generators->table.data(), generators->table.size(), &generators->of_random);
    any_ = true;
  }
  return *generators;
}

void RandomNumbers::add_state(StateHash& hash) const noexcept {
  for (const auto& of_process : generators_) {
    hash.add(of_process != nullptr);
    if (of_process == nullptr) continue;
    hash.add_memory(of_process->table.data(), of_process->table.size());
    hash.add(static_cast<std::uint64_t>(of_process->of_random.fptr - of_process->of_random.state));
    hash.add_memory(&of_process->of_drand48, sizeof of_process->of_drand48);
  }
}

}  // namespace ltsim
