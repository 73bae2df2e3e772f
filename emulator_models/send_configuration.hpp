// plc-emulator --send-config FILE: an engineering tool's part. Sends the file to the PLC that another plc-emulator
// --config runs, over its segment or its line, and tells what the PLC says to it.
//
// On a segment it takes the kernel's place, so none may be attached; the line is for one program at a time, too.
#pragma once

#include <string>

#include "emulator_models/emulator_options.hpp"

namespace emulator_models {

struct SendConfigurationOptions {
  std::string path;    ///< of the configuration; empty: this is not asked for
  std::string device;  ///< of the line; empty: the segment of the other options
};

/// Call it last: --send-config goes with few of the other options, which are looked for here.
/// @param options  filled when the command line is parsed; must outlive the parsing
void add_send_configuration_options(CLI::App& app, SendConfigurationOptions& options);

/// @param port  whose segment and options of the exchange are used
/// @return      the exit code: 0 = the PLC has taken it; 2 = it has not, and the reason is told
[[nodiscard]] int run_send_configuration(const SendConfigurationOptions& options,
                                         const EmulatorOptions& port);

}  // namespace emulator_models
