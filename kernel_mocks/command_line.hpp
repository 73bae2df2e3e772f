// What cnc-kernel can be told on its command line.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "kernel_mocks/part_program_runner.hpp"
#include "protocol/handoff_command_line.hpp"

namespace kernel_mocks {

struct CommandLine {
  std::string file;
  std::string segment;
  std::string device;
  std::string model = "FX3U";
  bool check_only = false;
  bool block_skip = false;
  bool table = false;
  RunnerOptions runner;
  unsigned read_timeout_ms = 200;
  unsigned fin_timeout_ms = 30'000;  ///< the machine's first tool change takes 14 s
  unsigned poll_interval_ms = 5;
  unsigned retries = 2;
  unsigned tmf_ms = 0;
  unsigned tfin_ms = 0;
  unsigned enq_wait_ms = 0;
  unsigned request_wait_ms = 0;
  std::string polling = "direct";
  std::string machine_table;
  std::string operator_script;
  unsigned baud_rate = 9600;
  protocol::HandoffArguments handoff;
};

/// @param arguments  filled when `app` parses; must outlive it
void add_options(CLI::App& app, CommandLine& arguments);

}  // namespace kernel_mocks
