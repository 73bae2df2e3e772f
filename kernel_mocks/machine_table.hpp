// Which M function acts when, and whether the program waits for it.
//
// The parser knows M codes as numbers; this table says what the machine has. Begin and end follow the column
// of ISO 6983 / EIA RS-274-D where it fixes them; README.md gives the choice where it does not.
#pragma once

#include <cstdint>

namespace kernel_mocks {

enum class EffectPoint : std::uint8_t {
  begin,  ///< before the motion of its block
  end,    ///< after it
};

enum class Acknowledgement : std::uint8_t {
  before_going_on,       ///< the block waits for FIN
  before_next_function,  ///< the program goes on; FIN is waited for before the next function is given
};

/// What the kernel itself does at this M code.
enum class ProgramFlow : std::uint8_t { none, stop, optional_stop, end };

struct MachineFunction {
  std::uint8_t code = 0;
  EffectPoint effect = EffectPoint::begin;
  /// Among the functions of one effect point the lower rank goes first; equal ranks as written.
  std::uint8_t rank = 1;
  Acknowledgement acknowledgement = Acknowledgement::before_going_on;
  /// False: the kernel's own business, the PLC never sees it.
  bool sent_to_plc = true;
  ProgramFlow flow = ProgramFlow::none;
};

/// @return the function, or nullptr when the machine has none of that number
[[nodiscard]] const MachineFunction* machine_function(std::uint8_t code) noexcept;

}  // namespace kernel_mocks
