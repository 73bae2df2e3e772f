// Command-line options of the handoff over shared memory, the same in every program that takes part in it: which one, and
// what each leaves to be chosen. Both sides must be told the same.
//
// An option of one handoff that is given with the other is refused: it would be without effect. What a program says of a segment
// that does not go with its options stands here, too, as it names them.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/handoff.hpp"

namespace CLI {
class App;
}

namespace protocol {

/// Which side of the handoff the program is; each has options that only it has.
enum class HandoffSide : std::uint8_t { kernel, emulator };

/// What the command line says.
struct HandoffArguments {
  Handoff protocol = Handoff::hardened;
  hardened::Options hardened;
  PaperOptions paper;

  /// Of the handoff that was asked for.
  [[nodiscard]] HandoffOptions options() const;
};

/// Sets the callback of `app`, which refuses what does not go together.
/// @param arguments  filled when the command line is parsed; must outlive the parsing
void add_handoff_options(CLI::App& app, HandoffArguments& arguments, HandoffSide side);

/// Of a program that plays the kernel and makes no segment of its own.
/// @return why there is no PLC on the segment for these options, and what to do about it; empty: its named objects are there
[[nodiscard]] std::string why_no_plc(const std::string& segment_name, const HandoffOptions& options);

/// How to start an emulator that goes with these options, but for capacities and the like.
[[nodiscard]] std::string emulator_command(const std::string& segment_name, const HandoffOptions& options);

}  // namespace protocol
