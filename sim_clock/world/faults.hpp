// Faults: what the scenario has granted, and how often each may still strike.
//
// The scenario grants a kind so many times an execution; the strategy is asked at each place where it could
// strike until that is used up. What is not granted is not asked for, so a new kind of fault does not move old
// schedules, and it costs a place one predictable branch.
//
// A crash is a kill -9 of one process. Its tasks stop where they stand: nothing is unwound or destroyed. Its
// mappings, descriptors and timers are gone. Shared memory and semaphores stay as they were, mutexes stay
// locked; the next owner of a robust one is told. Variables of the program stay, too: the processes of a world
// are one program, so whatever a new life of the process must find fresh, its tasks have to make.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/fault_kind.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class StateHash;
class World;

/// How a process may crash.
struct CrashGrant {
  unsigned times = 1;                      ///< at most, in an execution
  std::optional<SimTime> restart_after{};  ///< >= 0; nothing: it stays dead
};

class Faults {
 public:
  explicit Faults(World& world) noexcept : world_(world) {}
  void reset() noexcept;

  /// The kind may strike `times` times more often in this execution. Crashes are granted to a process,
  /// Process::may_crash().
  void grant(FaultKind kind, unsigned times) noexcept { left(kind) += times; }
  /// How often it can still strike in this execution; of crashes, over all processes.
  [[nodiscard]] std::uint32_t times_left(FaultKind kind) const noexcept {
    return left_[static_cast<std::size_t>(kind)];
  }
  void grant_crashes(ProcessId process, CrashGrant grant) noexcept;
  void grant_stalls(ProcessId process, unsigned times) noexcept;

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  /// Whether the fault strikes at this place, in one of so many ways.
  /// @param variants_count  >= 1
  /// @return                0: it does not; otherwise 1 to variants_count
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept {
    return can_strike(kind) ? ask(kind, variants_count) : 0;
  }
  /// The same where there is one way only.
  [[nodiscard]] bool strikes(FaultKind kind) noexcept { return strike(kind, 1) != 0; }

  /// Whether the kind was granted and is not used up.
  [[nodiscard]] bool can_strike(FaultKind kind) const noexcept {
    return left_[static_cast<std::size_t>(kind)] != 0;
  }
  [[nodiscard]] bool crash_is_possible() const noexcept { return can_strike(FaultKind::crash); }
  /// Whether something that strikes at any scheduling point is granted.
  [[nodiscard]] bool any_at_each_point() const noexcept {
    return crash_is_possible() || can_strike(FaultKind::process_stall);
  }
  /// Before any task runs: the bodies of processes that may start again are copied.
  void prepare_restarts();
  /// Asks whether one of the processes that run is killed here, and kills it.
  void choose_crash() noexcept;
  /// Asks whether one of the processes gets no processor for a while, beginning here.
  void choose_stall() noexcept;
  /// While the strategy is asked for a crash: the process that a variant would kill.
  /// @param variant  1 to variants_count
  [[nodiscard]] ProcessId crash_candidate(std::size_t variant) const noexcept {
    return crash_candidates_[variant - 1];
  }

 private:
  [[nodiscard]] std::uint32_t& left(FaultKind kind) noexcept { return left_[static_cast<std::size_t>(kind)]; }
  [[gnu::noinline]] std::size_t ask(FaultKind kind, std::size_t variants_count) noexcept;
  void crash(ProcessId id);

  World& world_;
  std::array<std::uint32_t, fault_kinds_count> left_{};  // of crashes: the sum over all processes
  std::array<CrashGrant, processes_max> crashes_{};      // by process; `times` is what is left
  std::array<ProcessId, processes_max> crash_candidates_{};
  std::array<std::uint32_t, processes_max> stalls_left_{};  // by process
  /// Those with a grant, whether or not it is used up: which variant means which process never changes.
  std::array<ProcessId, processes_max> stall_candidates_{};
  std::size_t stall_candidates_count_ = 0;
};

}  // namespace ltsim
