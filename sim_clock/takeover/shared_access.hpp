// An access to shared memory by the running task, with its scheduling point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "sim_clock/world/world.hpp"

namespace ltsim {

/// To a segment. Part of the function that calls it: another task may come back from the scheduling point, and each function it has
/// to leave then is one that the processor does not foresee.
[[gnu::always_inline]] inline void access_shared(World& world, const volatile void* address,
                                                 std::size_t bytes, OperationKind kind, std::uint32_t site,
                                                 bool is_seq_cst = false) noexcept {
  Operation operation = world.segments().arrive(address, bytes, kind, site);
  operation.is_seq_cst = is_seq_cst;
  world.scheduler().point(operation);
  world.segments().go_on(address, operation, world.scheduler().others_ran());
}

/// To memory of a whole program, if that is what runs and the address lies there.
/// @return whether that is so
inline bool access_program(World& world, const volatile void* address, std::size_t bytes, OperationKind kind,
                           std::uint32_t site, bool is_seq_cst = false) noexcept {
  if (!ProgramMemory::is_on()) return false;
  const auto place = ProgramMemory::find(address);
  if (!place) return false;
  world.program_memory().access(address, *place, bytes, kind, site, is_seq_cst);
  return true;
}

/// Where the checks know the address by; nothing where it is no shared memory.
[[nodiscard]] inline std::optional<SharedPlace> shared_place(const volatile void* address) noexcept {
  if (Segments::contains(address)) return Segments::place_of(address);
  if (!ProgramMemory::is_on()) return std::nullopt;
  const auto place = ProgramMemory::find(address);
  return place ? std::optional{place->place} : std::nullopt;
}

}  // namespace ltsim
