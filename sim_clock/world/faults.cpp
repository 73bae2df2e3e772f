#include "sim_clock/world/faults.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

void Faults::reset() noexcept {
  left_.fill(0);
  crashes_.fill({.times = 0, .restart_after = {}});
  stalls_left_.fill(0);
  stall_candidates_count_ = 0;
}

void Faults::grant_crashes(ProcessId process, CrashGrant grant) noexcept {
  left(FaultKind::crash) += grant.times;
  crashes_[process] = {.times = crashes_[process].times + grant.times, .restart_after = grant.restart_after};
}

void Faults::grant_stalls(ProcessId process, unsigned times) noexcept {
  left(FaultKind::process_stall) += times;
  ProcessId* const end = stall_candidates_.begin() + stall_candidates_count_;
  if (std::find(stall_candidates_.begin(), end, process) == end)
    stall_candidates_[stall_candidates_count_++] = process;
  stalls_left_[process] += times;
}

std::size_t Faults::ask(FaultKind kind, std::size_t variants_count) noexcept {
  const std::size_t variant = world_.scheduler().strike(kind, variants_count);
  if (variant == 0) return 0;
  --left(kind);
  world_.note([&] { return fmt::format("fault: {}, variant {}", to_string(kind), variant); });
  return variant;
}

void Faults::prepare_restarts() {
  for (std::size_t id = 0; id < world_.processes_count(); ++id) {
    if (crashes_[id].times != 0 && crashes_[id].restart_after)
      world_.process(static_cast<ProcessId>(id)).remember_tasks();
  }
}

void Faults::choose_crash() noexcept {
  std::size_t count = 0;
  for (std::size_t id = 0; id < world_.processes_count(); ++id) {
    const Process& process = world_.process(static_cast<ProcessId>(id));
    if (crashes_[id].times != 0 && process.is_running()) crash_candidates_[count++] = process.id();
  }
  if (count == 0) return;
  const std::size_t variant = world_.scheduler().strike(FaultKind::crash, count);
  if (variant != 0) crash(crash_candidate(variant));
}

void Faults::choose_stall() noexcept {
  using namespace std::chrono_literals;
  constexpr std::array<SimTime, 5> durations{1ms, 10ms, 100ms, 1s, 10s};
  const std::size_t variant = strike(FaultKind::process_stall, stall_candidates_count_ * durations.size());
  if (variant == 0) return;
  const ProcessId id = stall_candidates_[(variant - 1) / durations.size()];
  if (stalls_left_[id] == 0) {
    ++left(FaultKind::process_stall);  // this process has had all of its own; what is left is for others
    return;
  }
  --stalls_left_[id];
  const SimTime duration = durations[(variant - 1) % durations.size()];
  world_.note([&] {
    return fmt::format("{} gets no processor for {} ms", world_.process(id).name(), duration / 1ms);
  });
  world_.scheduler().stall_process(id, duration);
}

void Faults::crash(ProcessId id) {
  const GhostScope ghost;
  Process& process = world_.process(id);
  world_.note([&] { return fmt::format("fault: {} is killed", process.name()); });
  --left(FaultKind::crash);
  --crashes_[id].times;
  world_.close_down(id);
  process.died(crashes_[id].restart_after);
}

void Faults::add_state(StateHash& hash) const noexcept {
  for (const std::uint32_t left : left_) hash.add(left);
  for (const CrashGrant& grant : crashes_) hash.add(grant.times);
  for (const std::uint32_t left : stalls_left_) hash.add(left);
}

}  // namespace ltsim
