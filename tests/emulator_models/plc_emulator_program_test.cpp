// The real program with a PLC program of the user's own: mistakes, the watchdog, and how to start again.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "tests/emulator_models/emulator_process.hpp"
#include "tests/protocol/fx/worked_examples.hpp"

namespace emulator_models {
namespace {

using protocol::fx::examples::bytes;

/// A frame of the legacy commands, with its sum.
std::vector<std::byte> frame(std::string_view text) {
  unsigned sum = 3;
  std::vector<std::byte> made{std::byte{2}};
  for (const char c : text) {
    made.push_back(static_cast<std::byte>(c));
    sum += static_cast<unsigned char>(c);
  }
  made.push_back(std::byte{3});
  char digits[3];
  std::snprintf(digits, sizeof digits, "%02X", sum & 0xFFU);
  made.push_back(static_cast<std::byte>(digits[0]));
  made.push_back(static_cast<std::byte>(digits[1]));
  return made;
}

struct PlcEmulatorProgram : ::testing::Test {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("ltsim-test-program-" + std::to_string(::getpid()) + ".il"))
          .string();

  void write(std::string_view source) const { std::ofstream{path} << source; }
  ~PlcEmulatorProgram() override { std::filesystem::remove(path); }
};

/// The hexadecimal digits of `count` bytes from an address on.
std::string read(const SerialLine& line, const char* address, unsigned count) {
  char request[8];
  std::snprintf(request, sizeof request, "0%s%02X", address, count);
  line.send(frame(request));
  const auto answer = line.receive(4 + 2 * std::size_t{count});
  std::string digits;
  for (std::size_t i = 1; i + 3 < answer.size(); ++i) digits += static_cast<char>(answer[i]);
  return digits;
}

void force_on(const SerialLine& line, const char* device) {
  line.send(frame(std::string{"7"} + device));
  EXPECT_EQ(line.receive(1), bytes("06"));
}

TEST_F(PlcEmulatorProgram, that_never_ends_is_caught_by_the_watchdog_and_started_again_by_m8035_and_m8036) {
  // Y0 and Y10 on; M0, which the port forces, is the end of the scan that never comes.
  write(
      "PROGRAM p VAR a AT Y0 : BOOL; b AT Y10 : BOOL; hang AT M0 : BOOL; END_VAR\n"
      "LD TRUE\nST a\nST b\nhere: LD hang\nJMPC here\nEND_PROGRAM\n");
  EmulatorProcess emulator{{"--pty", "--program", path, "--watchdog-ms", "300"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  while (read(line, "01E0", 1) != "09") {
  }
  EXPECT_EQ(read(line, "00A0", 2), "0101");
  EXPECT_EQ(read(line, "0E7A", 2), "0000");
  force_on(line, "0008");  // M0
  EXPECT_TRUE(emulator.wait_for_text("CPU-E: watchdog: scan "));
  EXPECT_EQ(read(line, "01E0", 1), "1A");    // M8000 to M8007: STOP, and M8004
  EXPECT_EQ(read(line, "0E7A", 2), "D917");  // D8061 = 6105
  EXPECT_EQ(read(line, "01E7", 1), "20");    // M8056 to M8063: M8061
  EXPECT_EQ(read(line, "00A0", 2), "0000");  // Y0 to Y17
  force_on(line, "230F");                    // M8035
  force_on(line, "240F");                    // M8036
  EXPECT_TRUE(emulator.wait_for_text("fault cleared, RUN"));
  while (read(line, "01E0", 1) != "09") {
  }
  EXPECT_EQ(read(line, "0E7A", 2), "0000");
  EXPECT_EQ(read(line, "00A0", 2), "0101");
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST_F(PlcEmulatorProgram, that_fails_is_told_with_its_file_and_place) {
  write("PROGRAM p VAR d AT D0 : INT; END_VAR\nLD 1\nDIV d\nST d\nEND_PROGRAM\n");
  EmulatorProcess emulator{{"--pty", "--program", path}};
  EXPECT_TRUE(emulator.wait_for_text("PROG-E: " + path + ":3:1: "));
  emulator.send_signal(SIGINT);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST_F(PlcEmulatorProgram, with_a_mistake_is_refused_with_its_file_line_and_column) {
  write("PROGRAM p\nLD nothing\nEND_PROGRAM\n");
  EmulatorProcess emulator{{"--pty", "--program", path}};
  EXPECT_EQ(emulator.wait_for_exit(), 2);
  EXPECT_NE(emulator.printed().find("plc-emulator: " + path + ":2:4: "), std::string::npos)
      << emulator.printed();
}

TEST_F(PlcEmulatorProgram, that_is_not_there_a_plant_or_a_failure_that_is_not_known_are_refused) {
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } uses[] = {{{"--pty", "--program", path + ".none"}, path + ".none: cannot be read"},
              {{"--pty", "--program", "/"}, "/: cannot be read"},
              {{"--pty", "--plant", "press"}, "machine-tool, propulsion, none"},
              {{"--pty", "--failure", "fire"}, "spindle-drive-fault"},
              {{"--pty", "--plant", "machine-tool", "--model", "FX1S"}, "FX1S has X0 to X17"},
              {{"--pty", "--watchdog-ms", "0"}, "watchdog-ms"}};
  for (const auto& use : uses) {
    EmulatorProcess emulator{use.arguments};
    EXPECT_EQ(emulator.wait_for_exit(), 2) << use.message;
    EXPECT_NE(emulator.printed().find(use.message), std::string::npos) << emulator.printed();
  }
}

}  // namespace
}  // namespace emulator_models
