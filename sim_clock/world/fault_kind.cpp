#include "sim_clock/world/fault_kind.hpp"

namespace ltsim {

std::string_view to_string(FaultKind kind) noexcept {
  switch (kind) {
    case FaultKind::crash:
      return "crash";
    case FaultKind::lost_post:
      return "lost-post";
    case FaultKind::doubled_post:
      return "doubled-post";
    case FaultKind::spurious_wake:
      return "spurious-wake";
    case FaultKind::interrupt:
      return "interrupt";
    case FaultKind::clock_step:
      return "clock-step";
    case FaultKind::bit_flip:
      return "bit-flip";
    case FaultKind::foreign_write:
      return "foreign-write";
    case FaultKind::call_failure:
      return "call-failure";
    case FaultKind::process_stall:
      return "process-stall";
  }
  return "?";
}

}  // namespace ltsim
