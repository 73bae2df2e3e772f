#include "emulator_models/emulator_options.hpp"

#include <CLI/CLI.hpp>

namespace emulator_models {
void add_options(CLI::App& app, EmulatorOptions& options) {
  app.add_option("--segment", options.segment_name, "Serve the shared-memory segment of this name");
  app.add_flag("--pty", options.pty, "Serve a pseudo-terminal; its path is printed");
  app.add_option_function<std::string>(
      "--model",
      [&options](const std::string& name) {
        const auto model = protocol::fx::parse_model(name);
        if (!model) throw CLI::ValidationError("--model", name + " is not one of FX1S, FX1N, FX2N, FX3U");
        options.model = *model;
      },
      "PLC model: FX1S, FX1N, FX2N or FX3U (default FX3U)");
  app.add_option("--scan-period-ms", options.scan_period_ms, "From one scan to the next")
      ->check(CLI::Range(1, 60'000))
      ->capture_default_str();
  app.add_option("--program", options.program_path,
                 "Instruction list to run (default: the program of the plant)");
  app.add_option_function<std::string>(
      "--plant",
      [&options](const std::string& name) {
        options.plant = parse_plant(name);
        if (!options.plant)
          throw CLI::ValidationError("--plant", name + " is not one of machine-tool, propulsion, none");
      },
      "What is behind the terminals: machine-tool, propulsion or none (default machine-tool; none with "
      "--program "
      "and on FX1S)");
  app.add_option(
         "--failure", options.failures,
         "NAME or NAME@SECONDS: what is broken in the plant, from the start or from then on; repeatable, an "
         "unknown NAME shows them all")
      ->allow_extra_args(false);
  app.add_option("--watchdog-ms", options.watchdog_ms, "D8000 at power-up: a longer scan ends in STOP")
      ->check(CLI::Range(1, 32'767))
      ->capture_default_str();
  app.add_flag("--cold", options.cold,
               "Each start of RUN clears latched devices and retained variables, too");
  CLI::Option* const archive = app.add_option(
      "--archive", options.archive.path,
      "SQLite file that keeps what the PLC does: scans, faults, mode changes, writes of the port");
  app.add_option("--archive-signals", options.archive.signals,
                 "Bits whose changes go into the archive, too: X0,Y17,M100")
      ->delimiter(',')
      ->needs(archive);
  app.add_option("--archive-rows", options.archive.rows_max, "Newest rows that the archive keeps")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}))
      ->capture_default_str()
      ->needs(archive);
  app.add_flag("--watch", options.watch,
               "Show the PLC's memory live; a line for each change when the output is not a terminal");
  protocol::add_handoff_options(app, options.handoff, protocol::HandoffSide::emulator);
  app.footer("Exit codes: 0 ended by a signal, 2 bad usage or a segment that cannot be had, 3 own fault.");
}

PlantKind plant_of(const EmulatorOptions& options) noexcept {
  const bool without = !options.program_path.empty() || options.model == protocol::fx::Model::fx1s;
  return options.plant.value_or(without ? PlantKind::none : PlantKind::machine_tool);
}

}  // namespace emulator_models
