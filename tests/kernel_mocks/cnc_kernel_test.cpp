// The program cnc-kernel as a user meets it without a PLC: messages and exit codes.
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/shell.hpp"

namespace {

class CncKernel : public testing::Test {
 protected:
  [[nodiscard]] test_support::ShellResult run(const std::string& arguments) const {
    return test_support::run_in(folder_.path(), fmt::format("'{}' {}", CNC_KERNEL_PROGRAM, arguments));
  }

  [[nodiscard]] std::string file_with(const std::string& text) const {
    const auto path = folder_.path() / "program.nc";
    std::ofstream{path} << text;
    return path.string();
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(CncKernel, checks_the_shipped_program_without_a_plc) {
  const auto ended = run(fmt::format("--check '{}'", FIRST_LIGHT_FILE));
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  EXPECT_NE(ended.output.find("can run on this machine"), std::string::npos) << ended.output;
}

TEST_F(CncKernel, names_file_line_and_word_of_a_program_that_it_cannot_read) {
  const std::string path = file_with("M3\nM3.5\nM30\n");
  const auto ended = run(fmt::format("--check '{}'", path));
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.output,
            fmt::format("cnc-kernel: {}: line 2, word 'M3.5': an M code is a whole number from 0 "
                        "to 199\n",
                        path));
}

TEST_F(CncKernel, exits_with_1_for_a_word_that_this_machine_cannot_carry_out) {
  const auto ended = run(fmt::format("--check '{}'", file_with("S70000 M3\nM30\n")));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("line 1, word 'S70000': the PLC takes whole numbers"), std::string::npos)
      << ended.output;
}

TEST_F(CncKernel, exits_with_2_for_a_file_that_is_not_there) {
  const auto ended = run("--check /no/such/file.nc");
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.output, "cnc-kernel: /no/such/file.nc cannot be opened\n");
}

TEST_F(CncKernel, exits_with_2_for_bad_usage) {
  EXPECT_EQ(run("").exit_code, 2);
  EXPECT_EQ(run("--no-such-option x.nc").exit_code, 2);
  EXPECT_EQ(run(fmt::format("--segment a --port b '{}'", FIRST_LIGHT_FILE)).exit_code, 2);
  EXPECT_EQ(run(fmt::format("--segment a --model FX9 '{}'", FIRST_LIGHT_FILE)).exit_code, 2);
  EXPECT_EQ(run(fmt::format("'{}'", FIRST_LIGHT_FILE)).exit_code, 2);
}

TEST_F(CncKernel, has_help) { EXPECT_EQ(run("--help").exit_code, 0); }

TEST_F(CncKernel, says_how_to_start_the_emulator_when_its_segment_does_not_exist) {
  const std::string segment = fmt::format("cnc_kernel_test_{}", ::getpid());
  const auto ended = run(fmt::format("'{}' --segment {}", FIRST_LIGHT_FILE, segment));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.output,
            fmt::format("cnc-kernel: no PLC on segment '{0}': there is no such segment. Start one: "
                        "plc-emulator --segment {0}\n",
                        segment));
}

TEST_F(CncKernel, says_that_a_device_cannot_be_opened) {
  const auto ended = run(fmt::format("'{}' --port /dev/no_such_tty", FIRST_LIGHT_FILE));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("no PLC on /dev/no_such_tty"), std::string::npos) << ended.output;
}

}  // namespace
