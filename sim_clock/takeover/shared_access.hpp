// An access to a shared segment by the running task, with its scheduling point.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim_clock/world/world.hpp"

namespace ltsim {

/// Part of the function that calls it: another task may come back from the scheduling point, and each function it has to leave
/// then is one that the processor does not foresee.
[[gnu::always_inline]] inline void access_shared(World& world, const volatile void* address,
                                                 std::size_t bytes, OperationKind kind, std::uint32_t site,
                                                 bool is_seq_cst = false) noexcept {
  Operation operation = world.segments().arrive(address, bytes, kind, site);
  operation.is_seq_cst = is_seq_cst;
  const std::uint64_t points_before = world.scheduler().points();
  world.scheduler().point(operation);
  const bool others_ran = world.scheduler().points() != points_before + 1;
  world.segments().go_on(address, operation, others_ran);
}

}  // namespace ltsim
