// rand(3), random(3) and drand48(3) of the simulated processes: the numbers that glibc gives, from a state that each process has for
// itself and that is, at the begin of an execution, as if srand(1) and nothing else had been called.
//
// None of them is a scheduling point: which of two tasks draws first is decided by what they do before.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;

class RandomNumbers {
 public:
  /// Of one process.
  struct Generators {
    std::array<char, 128> table{};  // TYPE_3, as that of random(3)
    random_data of_random{};
    drand48_data of_drand48{};
  };

  void reset() noexcept {
    if (!any_) return;
    for (auto& of_process : generators_) of_process.reset();
    any_ = false;
  }

  /// What of it decides what can follow. A table that the program gave to initstate(3) is memory of the program.
  void add_state(StateHash& hash) const noexcept;

  /// Those of the running task's process.
  [[nodiscard]] Generators& of_current();

 private:
  bool any_ = false;
  std::array<std::unique_ptr<Generators>, processes_max> generators_;
};

}  // namespace ltsim
