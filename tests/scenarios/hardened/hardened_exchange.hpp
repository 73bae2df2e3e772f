// The hardened handoff in a world: a kernel that calls through a hardened::Master, an emulator that serves with the
// EmulatorHandler. Production code on both sides; the PLC behind it is a mirror.
#pragma once

#include <cstdint>
#include <string_view>

#include "protocol/hardened/options.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

/// What is done, and under which circumstances. Payloads fill two copies of eight bytes in part, so that each area can
/// be seen half written.
struct HardenedExchange {
  enum class TimeOuts : bool { never, as_set };

  protocol::hardened::Options options = {};  ///< areas have room for 16 bytes, whatever they say
  TimeOuts time_outs = TimeOuts::as_set;     ///< never: both are an hour
  unsigned requests = 1;                     ///< of each life of the kernel, one after the other
  unsigned kernel_kills = 0;                 ///< at any step, and started again 5 ms later
  unsigned emulator_kills = 0;
  unsigned odd_rings = 0;    ///< so many posts count twice, and so many waits end by a signal
  unsigned lost_rings = 0;   ///< so many posts are lost; who sleeps on one is no fault then
  unsigned clock_steps = 0;  ///< so often the wall clock is set
  unsigned foreign_writes =
      0;  ///< so often a process that has no business there writes a byte of the segment
  bool emulator_stops = false;  ///< once, in an orderly way, and is started again
  bool opens_together =
      false;  ///< both sides open at the same time; otherwise the kernel when the emulator is up
  bool has_rivals = false;  ///< a second kernel and a second emulator open as soon as they can
  /// The state word that a former life has left; 0: a fresh segment.
  std::uint32_t word = 0;
  std::string_view only = {};  ///< the invariant to judge by, data races aside; empty: all
};

/// After its requests the kernel makes one more, with time to spare: whatever happened before, it must end
/// ok.
void run_hardened_exchange(ltsim::World& world, const HardenedExchange& exchange);

}  // namespace scenarios
