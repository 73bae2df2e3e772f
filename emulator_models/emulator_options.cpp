#include "emulator_models/emulator_options.hpp"

#include <map>

#include <CLI/CLI.hpp>

namespace emulator_models {
namespace {

using protocol::PaperOptions;

template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const std::map<std::string, Value>& choices, const std::string& help) {
  return app.add_option(name, value, help)->transform(CLI::CheckedTransformer(choices, CLI::ignore_case));
}

void add_paper_options(CLI::App& app, PaperOptions& paper) {
  const std::string group = "What the published handoff leaves open (the kernel must be told the same)";
  add_choice<PaperOptions::StateCoding>(app, "--state-coding", paper.state_coding,
                                        {{"enumeration", PaperOptions::StateCoding::enumeration},
                                         {"halves", PaperOptions::StateCoding::halves}},
                                        "K2: coding of the state word (default enumeration)")
      ->group(group);
  add_choice<PaperOptions::SemaphoreAfterAnswer>(
      app, "--semaphore-after-answer", paper.semaphore_after_answer,
      {{"wait", PaperOptions::SemaphoreAfterAnswer::wait},
       {"reset", PaperOptions::SemaphoreAfterAnswer::reset}},
      "K3: after an answer, wait for the semaphore or force it to 0 first (default wait)")
      ->group(group);
  add_choice<PaperOptions::Initialiser>(app, "--initialiser", paper.initialiser,
                                        {{"creator", PaperOptions::Initialiser::creator},
                                         {"slave", PaperOptions::Initialiser::slave},
                                         {"creator-and-slave", PaperOptions::Initialiser::creator_and_slave},
                                         {"nobody", PaperOptions::Initialiser::nobody}},
                                        "K5: who fills the segment with zeros (default creator)")
      ->group(group);
  add_choice<PaperOptions::AreaOrder>(app, "--area-order", paper.area_order,
                                      {{"length-first", PaperOptions::AreaOrder::length_first},
                                       {"bytes-first", PaperOptions::AreaOrder::bytes_first}},
                                      "K6: what of an area is written first (default length-first)")
      ->group(group);
  add_choice<PaperOptions::LengthCheck>(
      app, "--length-check", paper.length_check,
      {{"none", PaperOptions::LengthCheck::none},
       {"check-and-load-again", PaperOptions::LengthCheck::check_and_load_again},
       {"load-once", PaperOptions::LengthCheck::load_once}},
      "K9: check of the length found in an area (default none)")
      ->group(group);
  add_choice<PaperOptions::SemaphoreStart>(app, "--semaphore-start", paper.semaphore_start,
                                           {{"zero", PaperOptions::SemaphoreStart::zero},
                                            {"one", PaperOptions::SemaphoreStart::one},
                                            {"left-over", PaperOptions::SemaphoreStart::left_over}},
                                           "K10: count of the semaphore at the start (default zero)")
      ->group(group);
}

}  // namespace

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
  app.add_flag("--watch", options.watch,
               "Show the PLC's memory live; a line for each change when the output is not a terminal");
  add_paper_options(app, options.paper);
  app.footer("Exit codes: 0 ended by a signal, 2 bad usage or a segment that cannot be had, 3 own fault.");
}

}  // namespace emulator_models
