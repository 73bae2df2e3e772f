// The command line of plc-emulator.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emulator_models/archive/fx_archive.hpp"
#include "emulator_models/plant_choice.hpp"
#include "protocol/fx/address_map.hpp"
#include "protocol/handoff_command_line.hpp"

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
  std::string program_path;           ///< empty = the program of the plant
  std::optional<PlantKind> plant;     ///< without: what plant_of() says
  std::vector<std::string> failures;  ///< NAME or NAME@SECONDS
  unsigned watchdog_ms = 200;         ///< D8000 at power-up
  bool cold = false;                  ///< each start of RUN clears latched devices, too
  archive::FxArchiveOptions archive;
  protocol::HandoffArguments handoff;
};

/// @param options  filled when the command line is parsed; must outlive the parsing
void add_options(CLI::App& app, EmulatorOptions& options);

/// The plant that was asked for. Without that: a program of the user's own has none behind it, and an FX1S has not
/// the terminals for the machine tool that all others get.
[[nodiscard]] PlantKind plant_of(const EmulatorOptions& options) noexcept;

}  // namespace emulator_models
