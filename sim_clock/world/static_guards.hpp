// The guards of static variables that are initialised when they are first reached: Itanium C++ ABI, 3.3.3. libstdc++ has them
// too, but what is done there nobody sees.
//
// The first byte of a guard says that the variable is there; compilers look at it before they call. Who is at work on it is kept here,
// and not in the guard: where an execution was dropped in the middle of an initialiser, the next one begins it anew. Where a process
// was killed there, its next life waits for ever, as both have the same variables.
//
// Nobody but who has to wait passes a scheduling point here: the compilers' look is one, and a variable is only initialised in the first
// of all executions. So a search of all executions takes an initialiser for part of the steps around it.
#pragma once

#include <cstdint>
#include <vector>

#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class StaticGuards {
 public:
  explicit StaticGuards(World& world) noexcept : world_(world) {}
  void reset() noexcept {
    initialisations_.clear();
    named_count_ = 0;
  }

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

  // The calls, for the running task.
  /// Waits while another task initialises the variable. Who does so himself would wait for himself: a deadlock.
  /// @return whether the running task has to initialise it now
  bool acquire(std::uint64_t* guard) noexcept;
  /// It is there, for all who see that it is.
  void release(std::uint64_t* guard) noexcept;
  /// An exception has left its initialiser: the next one may try.
  void give_up(std::uint64_t* guard) noexcept;

  /// Who initialises the variable that somebody waits for; null: nobody.
  [[nodiscard]] const Task* owner_of(ObjectId variable) const noexcept;

 private:
  struct Initialisation {
    std::uint64_t guard;  // its address
    TaskId task;
    ObjectId object;  // 0 until somebody waits for it
  };

  [[nodiscard]] Initialisation* find(const std::uint64_t* guard) noexcept;
  /// The initialisation ends, and who waits for it goes on.
  void end(const std::uint64_t* guard) noexcept;

  World& world_;
  std::vector<Initialisation> initialisations_;  // under way
  std::uint32_t named_count_ = 0;
};

}  // namespace ltsim
