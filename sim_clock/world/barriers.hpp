// Barriers of the simulated world: pthread_barrier_t.
//
// How many have come lies in the pthread_barrier_t itself, so that one in a shared segment works across processes; who they are is
// kept here. PTHREAD_BARRIER_SERIAL_THREAD goes to the last who comes, as with glibc. What each has done before it came happens
// before what all do afterwards.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <string>
#include <vector>

#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class Barriers {
 public:
  explicit Barriers(World& world) noexcept : world_(world) {}
  void reset() noexcept { barriers_.clear(); }

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

  // The calls, for the running task; they return 0 or an error number as POSIX.1-2017 lists them.
  /// libc's pthread_barrier_init() has made it.
  void was_made(pthread_barrier_t* barrier) noexcept;
  /// What pthread_barrier_init() has not made ends the execution as a crash.
  /// @return 0; or PTHREAD_BARRIER_SERIAL_THREAD to the last who comes
  int wait(pthread_barrier_t* barrier) noexcept;
  /// While somebody waits, where glibc would wait for ever: the execution ends as an assertion.
  int destroy(pthread_barrier_t* barrier) noexcept;

  /// Whether a task of some execution has used this barrier: outside any task it is nobody's then.
  [[nodiscard]] static bool belongs_to_an_execution(const pthread_barrier_t* barrier) noexcept;

  /// "2 of 3 have come"
  [[nodiscard]] std::string describe(ObjectId barrier) const;

 private:
  struct State;
  struct Barrier {
    ObjectId object;
    std::uint32_t count;
    std::vector<TaskId> waiting;
  };

  State& resolve(pthread_barrier_t* barrier) noexcept;

  World& world_;
  std::vector<Barrier> barriers_;  // by State::number
};

}  // namespace ltsim
