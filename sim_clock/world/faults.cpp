#include "sim_clock/world/faults.hpp"

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

void Faults::reset() noexcept {
  left_.fill(0);
  crashes_.fill({.times = 0, .restart_after = {}});
}

void Faults::grant_crashes(ProcessId process, CrashGrant grant) noexcept {
  left(FaultKind::crash) += grant.times;
  crashes_[process] = {.times = crashes_[process].times + grant.times, .restart_after = grant.restart_after};
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

void Faults::crash(ProcessId id) {
  const GhostScope ghost;
  Process& process = world_.process(id);
  world_.note([&] { return fmt::format("fault: {} is killed", process.name()); });
  --left(FaultKind::crash);
  --crashes_[id].times;
  world_.scheduler().kill_tasks(id);
  world_.segments().process_died(id);
  process.died(crashes_[id].restart_after);
}

}  // namespace ltsim
