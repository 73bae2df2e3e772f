#include "sim_clock/explore/random_strategy.hpp"

namespace ltsim {

std::size_t RandomStrategy::choose_task(const TaskChoice& choice) noexcept {
  // Most choices are between two tasks: one bit.
  return choice.options.size() == 2 ? generator().bits(1)
                                    : generator().below(static_cast<std::uint32_t>(choice.options.size()));
}

}  // namespace ltsim
