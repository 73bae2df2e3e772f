// cnc-kernel: runs a part program against a PLC or a PLC emulator.
//
// Exit codes: 0 the program ran to its end; 1 it stopped, or this machine or the PLC refused it; 2 bad usage,
// or a part program that cannot be read; 3 our own fault.
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "kernel_mocks/command_line.hpp"
#include "kernel_mocks/console_report.hpp"
#include "kernel_mocks/machine_table_file.hpp"
#include "kernel_mocks/nc_parser.hpp"
#include "kernel_mocks/operator_script_file.hpp"
#include "kernel_mocks/part_program_file.hpp"
#include "kernel_mocks/part_program_runner.hpp"
#include "kernel_mocks/polled_link.hpp"
#include "protocol/handoff.hpp"
#include "protocol/posix_port_manager.hpp"
#include "protocol/role_lock.hpp"
#include "protocol/shared_memory_port_manager.hpp"

namespace {

using namespace kernel_mocks;

constexpr int exit_ended = 0;
constexpr int exit_stopped = 1;
constexpr int exit_usage = 2;
constexpr int exit_own_fault = 3;

std::atomic<bool> stop_asked_for{false};

int complain(int exit_code, const std::string& message) {
  std::fprintf(stderr, "cnc-kernel: %s\n", message.c_str());
  return exit_code;
}

/// SIGINT and SIGTERM ask for a stop; the second one ends the process whatever it waits for. A thread waits
/// for them, so that they interrupt no exchange with the PLC in mid-answer. To be called before any other
/// thread is started.
void stop_on_signals() {
  static sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread{[] {
    int signal = 0;
    sigwait(&signals, &signal);
    stop_asked_for.store(true);
    sigwait(&signals, &signal);
    std::_Exit(exit_stopped);
  }}.detach();
}

/// Tells why a run did not reach its end.
/// @return the exit code
int tell_end(const std::string& file, const RunResult& result) {
  switch (result.outcome) {
    case RunOutcome::ended:
      return exit_ended;
    case RunOutcome::stopped:
      return complain(exit_stopped,
                      fmt::format("{}: {}; nobody is there to press cycle start, so the run ends "
                                  "here. --continue-at-m0 goes on",
                                  file, result.message));
    case RunOutcome::refused:
    case RunOutcome::failed:
      return complain(exit_stopped, fmt::format("{}: {}", file, result.message));
  }
  return exit_own_fault;
}

int run_program(const Program& program, const CommandLine& arguments, protocol::fx::Model model,
                protocol::SerialPort& port, std::chrono::nanoseconds send_timeout, const std::string& where,
                const std::string& no_plc_hint) {
  FxDriver driver{port,
                  {.model = model,
                   .answer_timeout = std::chrono::milliseconds{arguments.read_timeout_ms},
                   .send_timeout = send_timeout,
                   .retries = arguments.retries,
                   .enq_wait = std::chrono::milliseconds{arguments.enq_wait_ms},
                   .request_wait = std::chrono::milliseconds{arguments.request_wait_ms}}};
  if (const auto connected = driver.connect(); !connected) {
    const bool port_failed = connected.error() == FxDriverError::port_failed;
    return complain(exit_stopped, fmt::format("no PLC on {}: {}. {}", where,
                                              port_failed ? to_string(driver.last_port_error())
                                                          : to_string(connected.error()),
                                              no_plc_hint));
  }

  const std::chrono::milliseconds poll_interval{arguments.poll_interval_ms};
  std::unique_ptr<PlcLink> link;
  if (arguments.polling == "helper") {
    link = std::make_unique<PolledLink>(driver, PolledLinkOptions{.poll_interval = poll_interval});
  } else {
    link = std::make_unique<DirectLink>(driver);
  }
  ConsoleReport report{*link};
  LogicTask logic_task{*link,
                       {.poll_interval = std::chrono::milliseconds{arguments.poll_interval_ms},
                        .fin_timeout = std::chrono::milliseconds{arguments.fin_timeout_ms},
                        .tmf = std::chrono::milliseconds{arguments.tmf_ms},
                        .tfin = std::chrono::milliseconds{arguments.tfin_ms}},
                       nullptr,
                       &stop_asked_for};
  PartProgramRunner runner{logic_task, arguments.runner, &report};
  fmt::print("{}: {} blocks, PLC {} on {}\n", arguments.file, program.blocks.size(),
             protocol::fx::to_string(model), where);
  report.show_outputs();
  const auto start = std::chrono::steady_clock::now();
  const RunResult result = runner.run(program);
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  link.reset();  // its thread counts, too
  const FxDriver::Counters& counters = driver.counters();
  fmt::print("{} {:.2f} s: {} handshakes, {} motions; {} requests, {} retries, {} time-outs\n",
             result.outcome == RunOutcome::ended ? "program ended after" : "program stopped after",
             duration.count(), report.function_count(), report.motion_count(), counters.requests,
             counters.retries, counters.time_outs);
  if (arguments.table) fmt::print("{}", report.table().to_text());
  std::fflush(stdout);
  const int code = tell_end(arguments.file, result);
  if (driver.request_in_doubt()) {
    complain(code,
             fmt::format("in doubt: {}. It may have been executed, and is not sent again: look what the "
                         "machine has done, and reset it before the next program",
                         to_string(*driver.request_in_doubt())));
  }
  return code;
}

int run_on_segment(const Program& program, const CommandLine& arguments, protocol::fx::Model model) {
  const protocol::HandoffOptions handoff = arguments.handoff.options();
  const std::string where = fmt::format("segment '{}'", arguments.segment);
  protocol::RoleLock role{arguments.segment, protocol::Role::kernel};
  if (const auto locked = role.try_lock(); !locked) {
    return complain(exit_stopped, locked.error() == protocol::RoleLockError::held_by_other
                                      ? fmt::format("another kernel is running on {}", where)
                                      : fmt::format("{}: {}", where, to_string(locked.error())));
  }
  // Opening would create what is missing, and leave behind a segment that nobody serves.
  if (const std::string why = protocol::why_no_plc(arguments.segment, handoff); !why.empty())
    return complain(exit_stopped, fmt::format("no PLC on {}: {}", where, why));
  protocol::SharedMemoryPortManager ports{handoff};
  const auto port = ports.port(arguments.segment);
  if (!port) return complain(exit_stopped, fmt::format("{}: {}", where, to_string(port.error())));
  const int code =
      run_program(program, arguments, model, **port, arguments.handoff.hardened.take_timeout, where,
                  fmt::format("If one is running, it was started with other options or hangs. Start one: {}",
                              protocol::emulator_command(arguments.segment, handoff)));
  (*port)->close();
  protocol::remove_if_unused(arguments.segment, handoff);
  return code;
}

int run_on_device(const Program& program, const CommandLine& arguments, protocol::fx::Model model) {
  protocol::PosixPortManager ports{{.baud_rate = arguments.baud_rate}};
  const auto port = ports.port(arguments.device);
  if (!port) return complain(exit_stopped, fmt::format("{}: {}", arguments.device, to_string(port.error())));
  return run_program(program, arguments, model, **port, std::chrono::milliseconds{arguments.read_timeout_ms},
                     arguments.device,
                     "Check the cable and the device path, or start an emulator: plc-emulator --pty");
}

int checked_main(int argc, char** argv) {
  CommandLine arguments;
  CLI::App app{"Runs a part program against a PLC or a PLC emulator."};
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_ended : exit_usage;
  }
  const auto model = protocol::fx::parse_model(arguments.model);
  if (!model) {
    return complain(exit_usage,
                    fmt::format("--model {}: not one of FX1S, FX1N, FX2N, FX3U", arguments.model));
  }
  if (!arguments.check_only && arguments.segment.empty() && arguments.device.empty()) {
    return complain(exit_usage,
                    "where is the PLC? --segment NAME or --port DEVICE (or --check to only read)");
  }

  stop_on_signals();
  const auto text = read_program_file(arguments.file);
  if (!text) return complain(exit_usage, fmt::format("{} {}", arguments.file, to_string(text.error())));
  const auto program = parse_program(*text, {.skip_optional_blocks = arguments.block_skip});
  if (!program)
    return complain(exit_usage, fmt::format("{}: {}", arguments.file, to_string(program.error())));
  MachineTable table = MachineTable::standard();
  if (!arguments.machine_table.empty()) {
    const auto file = read_program_file(arguments.machine_table);
    if (!file)
      return complain(exit_usage, fmt::format("{} {}", arguments.machine_table, to_string(file.error())));
    const auto parsed = parse_machine_table(*file);
    if (!parsed)
      return complain(exit_usage, fmt::format("{}: {}", arguments.machine_table, to_string(parsed.error())));
    table = *parsed;
  }
  arguments.runner.machine_table = &table;
  OperatorPanel panel;
  std::optional<ScriptedOperator> scripted;
  if (!arguments.operator_script.empty()) {
    const auto file = read_program_file(arguments.operator_script);
    if (!file)
      return complain(exit_usage, fmt::format("{} {}", arguments.operator_script, to_string(file.error())));
    const auto parsed = parse_operator_script(*file);
    if (!parsed)
      return complain(exit_usage,
                      fmt::format("{}: {}", arguments.operator_script, to_string(parsed.error())));
    scripted.emplace(*parsed);
    arguments.runner.panel = &panel;
    arguments.runner.operator_ = &*scripted;
  }
  if (const auto checked = check_for_machine(*program, table); !checked) {
    return complain(exit_stopped, fmt::format("{}: {}", arguments.file, to_string(checked.error())));
  }
  if (const auto checked = check_motion(*program, arguments.runner.axes); !checked) {
    return complain(exit_stopped, fmt::format("{}: {}", arguments.file, to_string(checked.error())));
  }
  if (arguments.check_only) {
    fmt::print("{}: {} blocks, can run on this machine\n", arguments.file, program->blocks.size());
    return exit_ended;
  }
  return arguments.segment.empty() ? run_on_device(*program, arguments, *model)
                                   : run_on_segment(*program, arguments, *model);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return checked_main(argc, argv);
  } catch (const std::exception& error) {
    return complain(exit_own_fault, fmt::format("internal error: {}", error.what()));
  }
}
