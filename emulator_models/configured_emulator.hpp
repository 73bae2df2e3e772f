// plc-emulator --config FILE: a soft PLC of several cycles in real time, as its configuration says.
//
//   start             RUN
//   SIGINT, SIGTERM, end of --seconds   STOP, drivers get the safe outputs, report; exit 0
//   SIGHUP            the file is loaded again; a bad one, or one that needs STOP, is refused whole and told
//   over the wire     another configuration comes to the programming port (configuration_frames.hpp): the same; the file
//                     stays as it is, and counts again with SIGHUP and with the next start
//   SIGUSR1           report
//   SIGUSR2           the RUN/STOP switch: STOP; or reset of a fault and cold RUN
//
// Faults and the alarm lamp are told on standard error as soon as they are there (looked for every 10 ms); the PLC
// stays in STOP until SIGUSR2. A PLC that SIGHUP has built anew is in STOP, too: nothing starts by itself.
#pragma once

#include <string>

#include "emulator_models/emulator_options.hpp"

namespace emulator_models {

struct ConfiguredEmulatorOptions {
  std::string path;      ///< of the configuration; empty: this mode is not asked for
  unsigned seconds = 0;  ///< 0: until a signal comes
};

/// Call it last: --config goes with few of the other options, which are looked for here.
/// @param options  filled when the command line is parsed; must outlive the parsing
void add_configured_options(CLI::App& app, ConfiguredEmulatorOptions& options);

/// @param port  segment and pseudo-terminal are served as configured_port.hpp says; the rest is not looked at
/// @return      the exit code: 0, or 2 for a bad file or a segment that cannot be had, 3 without a pseudo-terminal
[[nodiscard]] int run_configured_emulator(const ConfiguredEmulatorOptions& options,
                                          const EmulatorOptions& port);

}  // namespace emulator_models
