// The random walk: at each scheduling point every task that can run is equally likely to run next. Time passes
// in bursts.
#pragma once

#include "sim_clock/explore/sampling_strategy.hpp"

namespace ltsim {

class RandomStrategy final : public SamplingStrategy {
 public:
  [[nodiscard]] std::string_view name() const noexcept override { return "random"; }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] bool passes_uncontended() const noexcept override { return false; }

 private:
  TimeMode begin() noexcept override { return TimeMode::bursts; }
};

}  // namespace ltsim
