// Which M function acts when, and what waits for it.
//
// The parser knows M codes as numbers; this table says what the machine has. standard() follows the column of
// ISO 6983 / EIA RS-274-D where it fixes begin and end; README.md gives the choice where it does not. Another
// machine's table is read from a file (machine_table_file.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace kernel_mocks {

enum class EffectPoint : std::uint8_t {
  begin,  ///< before the motion of its block
  end,    ///< after it
};

/// What must not begin before FIN. The synchronisation kinds of a commercial kernel are pairs of effect point
/// and this; README.md, "Synchronisation kinds".
enum class Acknowledgement : std::uint8_t {
  before_going_on,       ///< the block waits at once: MVS_SVS (begin), MNS_SNS (end)
  before_next_function,  ///< nothing but the next function waits: MOS
  at_block_end,          ///< the motion of the block runs meanwhile: MVS_SNS
  before_feed,           ///< the next motion at feed waits, rapids do not: MVS_SLM
};

/// What the kernel itself does at this M code.
enum class ProgramFlow : std::uint8_t { none, stop, optional_stop, end };

/// What becomes of the spindle: motion at feed after a start waits for "spindle at speed".
enum class SpindleEffect : std::uint8_t { none, start, stop };

struct MachineFunction {
  std::uint8_t code = 0;
  EffectPoint effect = EffectPoint::begin;
  /// Among the functions of one effect point the lower rank goes first; equal ranks as written.
  std::uint8_t rank = 1;
  Acknowledgement acknowledgement = Acknowledgement::before_going_on;
  /// False: the kernel's own business, the PLC never sees it.
  bool sent_to_plc = true;
  ProgramFlow flow = ProgramFlow::none;
  SpindleEffect spindle = SpindleEffect::none;

  bool operator==(const MachineFunction&) const = default;
};

class MachineTable {
 public:
  static constexpr unsigned code_max = 199;

  /// The machine of README.md.
  [[nodiscard]] static const MachineTable& standard() noexcept;

  /// @param code  0 to code_max
  /// @return      the function, or nullptr when the machine has none of that number
  [[nodiscard]] const MachineFunction* find(std::uint8_t code) const noexcept;
  /// @param function  its code: 0 to code_max; one that is there already is replaced
  void put(const MachineFunction& function) noexcept;

  bool operator==(const MachineTable&) const = default;

 private:
  std::array<std::optional<MachineFunction>, code_max + 1> functions_;
};

}  // namespace kernel_mocks
