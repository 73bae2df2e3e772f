#include "kernel_mocks/command_line.hpp"

#include <vector>

#include "kernel_mocks/axis_limit_text.hpp"

namespace kernel_mocks {

void add_options(CLI::App& app, CommandLine& arguments) {
  app.add_option("program", arguments.file, "Part program file (ISO-7bit)")->required();
  auto* const segment =
      app.add_option("--segment", arguments.segment, "Shared-memory segment of a PLC emulator");
  app.add_option("--port", arguments.device, "Serial device of a PLC, e.g. /dev/ttyUSB0 or /dev/pts/3")
      ->excludes(segment);
  app.add_flag("--check", arguments.check_only, "Only read and check the part program; no PLC is needed");
  app.add_option("--model", arguments.model, "PLC model: FX1S, FX1N, FX2N or FX3U")->capture_default_str();
  app.add_flag("--skip-optional-blocks", arguments.block_skip,
               "Operator's switch for blocks that begin with /");
  app.add_flag("--optional-stop", arguments.runner.optional_stop, "Operator's switch for M1");
  app.add_flag("--continue-at-m0", arguments.runner.continue_at_stop,
               "Go on after M0 (and M1) as if cycle start had been pressed; without it the run ends there");
  app.add_option("--read-timeout-ms", arguments.read_timeout_ms, "Longest wait for an answer of the PLC")
      ->check(CLI::Range(1, 3'600'000))
      ->capture_default_str();
  app.add_option("--retries", arguments.retries,
                 "Repetitions of a request without a good answer; never of one that sets something and may "
                 "have been\n"
                 "executed, where the port can tell")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_option("--fin-timeout-ms", arguments.fin_timeout_ms, "Longest wait for FIN")
      ->check(CLI::Range(1, 86'400'000))
      ->capture_default_str();
  app.add_option("--poll-interval-ms", arguments.poll_interval_ms, "Pause between two looks for FIN")
      ->check(CLI::Range(0, 60'000))
      ->capture_default_str();
  app.add_option("--tmf-ms", arguments.tmf_ms, "From the code to its strobe")->check(CLI::Range(0, 60'000));
  app.add_option("--tfin-ms", arguments.tfin_ms, "Shortest FIN that counts")->check(CLI::Range(0, 60'000));
  app.add_option("--enq-wait-ms", arguments.enq_wait_ms, "Fixed pause after ENQ")
      ->check(CLI::Range(0, 60'000));
  app.add_option("--request-wait-ms", arguments.request_wait_ms, "Fixed pause after each request")
      ->check(CLI::Range(0, 60'000));
  app.add_option("--polling", arguments.polling,
                 "Who uses the port: each task (direct), or one thread (helper)")
      ->check(CLI::IsMember({"direct", "helper"}))
      ->capture_default_str();
  app.add_flag("--table", arguments.table,
               "After the run a table of the M, S and T functions: begin, FIN, duration, result");
  app.add_option("--machine-table", arguments.machine_table, "M functions of the machine (TOML)");
  app.add_option("--operator", arguments.operator_script, "What the operator presses when (TOML)");
  app.add_option("--motion-percent", arguments.runner.axes.time_percent,
                 "Motion lasts so many percent of its time; 0: none at all")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_option_function<double>(
         "--rapid", [&axes = arguments.runner.axes](double rate) { axes.rapid.fill(rate); },
         "Rate of rapid motion of each axis in mm/min (degrees/min); no feed is faster")
      ->check(CLI::Range(1.0, 1e6))
      ->default_str("10000");
  app.add_option_function<std::vector<std::string>>(
         "--axis-limit",
         [&axes = arguments.runner.axes](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             const AxisLimit limit = *parse_axis_limit(text);
             axes.travel[limit.axis] = limit.travel;
           }
         },
         "Travel of an axis in machine coordinates, e.g. X=-50:650; may be given for each axis; else endless")
      ->check(CLI::Validator{[](const std::string& text) {
                               return parse_axis_limit(text)
                                          ? ""
                                          : "an axis limit is an axis, its least and its greatest position, "
                                            "with zero between them: X=-50:650";
                             },
                             "AXIS=MIN:MAX"})
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--tool-change-z", arguments.runner.axes.tool_change_z,
                 "Z from which on it stands at the tool change position, mm (machine coordinates)")
      ->capture_default_str();
  app.add_option("--baud", arguments.baud_rate, "Bits per second of the serial device")
      ->check(CLI::IsMember({9600, 19200, 38400, 57600, 115200}))
      ->capture_default_str();
  protocol::add_handoff_options(app, arguments.handoff, protocol::HandoffSide::kernel);
  app.footer(
      "Exit codes: 0 ran to its end, 1 stopped or refused, 2 bad usage or unreadable program, 3 own fault.");
}

}  // namespace kernel_mocks
