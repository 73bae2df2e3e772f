// A shift at the machine tool: part programs drawn at random, an operator who presses buttons, a machine that
// fails; on the whole kernel and the whole emulator, over the published handoff.
#pragma once

#include <string_view>

#include "emulator_models/soft_plc/il_program.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/machine/watched_machine.hpp"

namespace scenarios {

enum class FinWait { until_low, none };
/// When a strobe falls.
enum class StrobeHold { until_fin, fixed_time };

/// What the world does to kernel and PLC beside holding them up: at most so often in a shift.
struct ShiftFaults {
  unsigned kernel_kills = 0;
  unsigned plc_kills = 0;
  unsigned stalls = 0;  ///< of each of the two
  unsigned interrupts = 0;
  unsigned clock_steps = 0;
  unsigned lost_posts = 0;
  unsigned doubled_posts = 0;

  /// Something can be lost that only a time-out brings back.
  [[nodiscard]] constexpr bool need_time_outs() const noexcept {
    return plc_kills > 0 || lost_posts > 0 || doubled_posts > 0;
  }
};

struct ShiftSetup {
  PortService service = PortService::at_scan_boundary;
  /// none: the kernel takes FIN for low as soon as it has let its strobes fall.
  FinWait fin_wait = FinWait::until_low;
  /// fixed_time: the kernel lets it fall after four scans and takes its function for done.
  StrobeHold strobe_hold = StrobeHold::until_fin;
  /// The interlock to judge by; empty: all.
  std::string_view only_rule{};
  ShiftFaults faults{};
};

/// @param program  of the PLC, compiled for an FX3U
void run_shift(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
               const ShiftSetup& setup = {});

}  // namespace scenarios
