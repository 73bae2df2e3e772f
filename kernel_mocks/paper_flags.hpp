// The open questions of the published handoff design (protocol/paper_options.hpp) as command line options.
#pragma once

#include "protocol/paper_options.hpp"

namespace CLI {
class App;
}

namespace kernel_mocks {

/// Adds an option for every question that the kernel's side of the segment answers.
/// @param options  filled when the command line is parsed; must outlive the parsing
void add_paper_flags(CLI::App& app, protocol::PaperOptions& options);

}  // namespace kernel_mocks
