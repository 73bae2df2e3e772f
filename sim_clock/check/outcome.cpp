#include "sim_clock/check/outcome.hpp"

namespace ltsim {

std::string_view to_string(OutcomeKind kind) noexcept {
  switch (kind) {
    case OutcomeKind::passed:
      return "passed";
    case OutcomeKind::invariant:
      return "invariant";
    case OutcomeKind::assertion:
      return "assertion";
    case OutcomeKind::deadlock:
      return "deadlock";
    case OutcomeKind::livelock:
      return "livelock";
    case OutcomeKind::data_race:
      return "data-race";
    case OutcomeKind::leak:
      return "leak";
    case OutcomeKind::crash:
      return "crash";
    case OutcomeKind::exit:
      return "exit";
    case OutcomeKind::unsupported:
      return "unsupported";
  }
  return "?";
}

}  // namespace ltsim
