// POSIX semaphores of the simulated world, named and not.
//
// As on Linux a post makes the count visible to everybody and wakes the longest waiting task; another task
// that runs first may take the token away from it. A post beyond the maximum (EOVERFLOW), or beyond the bound that
// a scenario gives, is lost or was never meant: it ends the execution.
#pragma once

#include <semaphore.h>

#include <array>
#include <climits>
#include <cstdint>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/handle.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

class Semaphores {
 public:
  static constexpr unsigned value_max = SEM_VALUE_MAX;
  static constexpr std::size_t semaphores_max = 256;  // in one execution

  /// Whether open() returned it, in this execution or another.
  [[nodiscard]] static bool is_named(const sem_t* handle) noexcept {
    return handle >= handles_.data() && handle < handles_.data() + handles_.size();
  }

  explicit Semaphores(World& world) noexcept : world_(world) {}
  void reset() noexcept {
    count_ = 0;
    bounds_.clear();
  }

  /// See World::bound_semaphore().
  void bound(std::string_view name, unsigned count_max);

  /// At set-up: a named semaphore that is there already.
  /// @return the value; 0 of what is no semaphore
  [[nodiscard]] unsigned value_of(ObjectId object) const noexcept;
  void leave(std::string_view path, unsigned value);

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  // The calls, for the running task; errors as POSIX.1-2017 lists them, in errno.
  /// After its scheduling point, which is the caller's: another task may come back from there, and each function it has to
  /// leave is one that the processor does not foresee.
  sem_t* open(std::string_view path, int flags, unsigned value) noexcept;
  int close(sem_t* handle) noexcept;
  int unlink(std::string_view path) noexcept;
  int init(sem_t* handle, bool shared, unsigned value) noexcept;
  int destroy(sem_t* handle) noexcept;
  int wait(sem_t* handle) noexcept;
  int try_wait(sem_t* handle) noexcept;
  int timed_wait(sem_t* handle, clockid_t clock, const timespec& deadline) noexcept;
  int post(sem_t* handle) noexcept;
  int value(sem_t* handle, int& into) noexcept;

 private:
  struct Semaphore {
    std::string name;  // empty: not named
    ObjectId object = 0;
    unsigned value = 0;
    unsigned value_meant_max = value_max;  // a bound of the scenario, or the system's
    bool linked = false;
    bool shared =
        true;  // between processes; a post of another process does not wake who waits for one that is not
  };

  struct Bound {
    std::string name;
    unsigned count_max;
  };

  /// Ends the execution: the semaphore would have the count `value`.
  void exceeds_bound(const Semaphore& semaphore, std::uint64_t value);
  /// How messages call a semaphore without a name: one that begins a segment by the segment's.
  [[nodiscard]] std::string name_by_place(const sem_t* handle) const;
  /// @return its handle
  sem_t& create(std::string_view name, std::string_view shown_name, unsigned value);
  [[nodiscard]] Semaphore* find(std::string_view name) noexcept;
  /// Ends the execution as a crash if the memory holds no semaphore of this execution.
  Semaphore& resolve(sem_t* handle, OperationKind kind) noexcept;
  /// resolve(), scheduling point, and resolve() again: the semaphore may have gone meanwhile.
  Semaphore& arrive_at(sem_t* handle, OperationKind kind) noexcept;
  void add_one(Semaphore& semaphore) noexcept;
  [[nodiscard]] static WaitKey key_of(const Semaphore& semaphore) noexcept;
  int wait_until(sem_t* handle, OperationKind kind, Deadline deadline) noexcept;
  /// One token, and with it all that its post comes after.
  void take_token(Semaphore& semaphore) noexcept;

  World& world_;
  static inline std::array<sem_t, semaphores_max> handles_{};  // what open() returns, by index
  std::array<Semaphore, semaphores_max> semaphores_;           // the first count_ belong to this execution
  std::size_t count_ = 0;
  std::vector<Bound> bounds_;
};

}  // namespace ltsim
