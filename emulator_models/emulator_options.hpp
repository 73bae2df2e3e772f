// The command line of plc-emulator.
#pragma once

#include <chrono>
#include <string>

#include "protocol/fx/address_map.hpp"
#include "protocol/paper_options.hpp"

namespace CLI {
class App;
}

namespace emulator_models {

struct EmulatorOptions {
  std::string segment_name;  ///< empty = no segment
  bool pty = false;
  bool watch = false;
  protocol::fx::Model model = protocol::fx::Model::fx3u;
  unsigned scan_period_ms = 10;
  protocol::PaperOptions paper;
};

/// @param options  filled when the command line is parsed; must outlive the parsing
void add_options(CLI::App& app, EmulatorOptions& options);

}  // namespace emulator_models
