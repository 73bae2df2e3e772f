// What the workers of an exploration tell while they run, in memory that survives the death of each of them.
//
// The executions are dealt out in turn: with J workers, worker w (from 0) runs the executions 1 + w, 1 + w + J,
// 1 + w + 2J ... It adds a record for each that has ended, so the number of its records says
// which one is under way. The parent takes the records; when a worker has died, it adds the one that is
// missing.
//
// Invariants
//   I1  taken <= ended <= begun <= ended + 1, ended - taken <= records_max.
//   I2  one process writes a field at a time: `begun`, `ended` and `position` the worker, `taken` the parent, and the
//       parent all of them while the worker is dead.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "sim_clock/explore/explorer.hpp"

namespace ltsim {

struct WorkerProgress {
  static constexpr std::size_t records_max = std::size_t{1} << 15U;

  std::atomic<std::uint64_t> begun;  ///< executions
  std::atomic<std::uint64_t> ended;  ///< executions; releases their records
  /// Differs from what it was when a scheduling point was passed; as of when the parent last asked.
  std::atomic<std::uint64_t> position;
  alignas(64) std::atomic<std::uint64_t> taken;  ///< records; releases their places
  alignas(64) std::array<ExecutionResult, records_max> records;

  [[nodiscard]] ExecutionResult& record(std::uint64_t index) noexcept { return records[index % records_max]; }
};

/// How far the exploration goes. Written by all, read before each execution.
struct alignas(64) ExplorationBounds {
  std::atomic<std::uint64_t> execution_last;  ///< none after it counts; it only falls
  std::atomic<bool> stop;                     ///< begin no execution any more

  void end_at(std::uint64_t execution) noexcept {
    std::uint64_t last = execution_last.load(std::memory_order_relaxed);
    while (execution < last && !execution_last.compare_exchange_weak(last, execution)) {
    }
  }
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<bool>::is_always_lock_free,
              "a lock cannot span processes");

/// The memory itself, shared with the processes forked while it lives.
class SharedProgress {
 public:
  /// @throw std::system_error when there is no memory
  SharedProgress(unsigned workers_count, std::uint64_t execution_last);
  ~SharedProgress();
  SharedProgress(const SharedProgress&) = delete;
  SharedProgress& operator=(const SharedProgress&) = delete;

  [[nodiscard]] ExplorationBounds& bounds() const noexcept { return *bounds_; }
  [[nodiscard]] WorkerProgress& worker(unsigned number) const noexcept { return workers_[number]; }

 private:
  std::size_t bytes_;
  ExplorationBounds* bounds_;
  WorkerProgress* workers_;
};

}  // namespace ltsim
