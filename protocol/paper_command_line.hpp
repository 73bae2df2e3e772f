// Command-line options for the questions that the published design leaves open (paper_options.hpp), the same
// in every program that takes part in the handoff: both sides must be told the same.
#pragma once

#include <cstdint>

#include "protocol/paper_options.hpp"

namespace CLI {
class App;
}

namespace protocol {

/// Which side of the handoff the program is; each has questions that only it answers.
enum class PaperSide : std::uint8_t { kernel, emulator };

/// @param options  filled when the command line is parsed; must outlive the parsing
void add_paper_options(CLI::App& app, PaperOptions& options, PaperSide side);

}  // namespace protocol
