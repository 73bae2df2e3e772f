// The checks that come with every access to shared memory and every synchronisation: data races, memory that
// changed unseen, and what is new in an execution. The world and the takeover functions tell them here.
//
// Each call costs one branch when the checks are off.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "sim_clock/check/happens_before.hpp"
#include "sim_clock/check/memory_watch.hpp"
#include "sim_clock/check/race_detector.hpp"
#include "sim_clock/explore/coverage.hpp"

namespace ltsim {

class MemoryChecks {
 public:
  /// @param memory        all segments, one after the other, by SharedPlace; outlives this
  /// @param places_count  of all shared memory: a multiple of 8
  MemoryChecks(const std::byte* memory, std::size_t places_count)
      : races_(order_, places_count), watch_(memory) {}
  /// Forgets the last execution, but not what the exploration has seen.
  void reset() noexcept;

  /// What orders tasks is followed in this execution, also if the checks are off. Before the first task begins.
  void follow_order() noexcept { follows_order_ = true; }
  [[nodiscard]] HappensBefore& order() noexcept { return order_; }
  /// See HappensBefore. In all executions.
  void follow_family() noexcept { order_.follow_family(); }

  /// On or off for the executions that begin from now on.
  void set_on(bool on) noexcept { wanted_on_ = on; }
  [[nodiscard]] bool on() const noexcept { return on_; }
  void allow_races() noexcept { races_allowed_ = true; }

  // --- shared memory ---

  /// A task goes on to access memory that the world sees.
  /// @return whether it is there as it should be
  [[nodiscard]] bool before_access(SharedPlace place, std::size_t bytes, bool writes) noexcept {
    return !on_ || watch_.access(place, bytes, writes);
  }
  /// A write that was announced before, in pieces, is about to be made only now.
  void announce_write(SharedPlace place, std::size_t bytes) noexcept {
    if (on_) watch_.announce(place, bytes);
  }
  /// The world itself has changed the bytes just now.
  void accept_change(SharedPlace place, std::size_t bytes) noexcept {
    if (on_) watch_.accept(place, bytes);
  }
  /// The world has filled the bytes with zeros just now. Also when the checks are off: they may be on in the next execution.
  void was_zeroed(SharedPlace place, std::size_t bytes) noexcept { watch_.zero(place, bytes); }
  [[nodiscard]] std::optional<SharedPlace> find_unseen_change(SharedPlace place, std::size_t bytes) noexcept {
    return on_ ? watch_.find_change(place, bytes) : std::nullopt;
  }
  /// The access itself. @param reads  an update both reads and writes
  void accessed(const SharedAccess& access, bool reads) {
    const RaceDetector::LastWrite last = races_.access(access);
    if (reads) coverage_.reads_from(last, access);
  }
  [[nodiscard]] bool is_contended(const SharedAccess& access) const noexcept {
    return races_.is_contended(access);
  }
  /// An atomic access has been made.
  /// @param canonical_address  Segments::canonical(), which names it also outside of segments
  /// @param shared             it is shared memory, at `where.place`
  void atomic(SharedAccess where, std::uint64_t canonical_address, bool shared, AtomicAccess access,
              int order) {
    const SyncKey key = SyncKey::atomic(canonical_address);
    order_.before_atomic(where.task, key, access, order);
    if (shared) accessed(where, reads(access));
    order_.after_atomic(where.task, key, access, order);
  }
  /// @return the first race of the execution, unless races are allowed in it
  [[nodiscard]] std::optional<Race> race() const noexcept {
    return races_allowed_ ? std::nullopt : races_.race();
  }

  // --- what orders tasks; see HappensBefore ---

  void task_begins(TaskId task) {
    if (follows_order_) order_.begins(task);
  }
  void follows(TaskId later, TaskId earlier) noexcept {
    if (follows_order_) order_.follows(later, earlier);
  }
  void release(TaskId task, SyncKey key) {
    if (follows_order_) order_.release(task, key);
  }
  void acquire(TaskId task, SyncKey key) noexcept {
    if (follows_order_) order_.acquire(task, key);
  }
  void forget(SyncKey key) noexcept {
    if (follows_order_) order_.forget(key);
  }
  void fence(TaskId task, int order) {
    if (follows_order_) order_.fence(task, order);
  }

  [[nodiscard]] Coverage& coverage() noexcept { return coverage_; }

 private:
  bool on_ = false;
  bool follows_order_ = false;
  bool wanted_on_ = true;
  bool races_allowed_ = false;
  HappensBefore order_;
  RaceDetector races_;
  MemoryWatch watch_;
  Coverage coverage_;
};

}  // namespace ltsim
