// cnc-kernel against plc-emulator: two real processes over real shared memory.
#include <unistd.h>

#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/emulator_models/emulator_process.hpp"
#include "tests/support/shell.hpp"

namespace {

class KernelAndEmulator : public testing::Test {
 protected:
  KernelAndEmulator() { EXPECT_FALSE(emulator_.wait_for_line("segment: ").empty()); }

  [[nodiscard]] test_support::ShellResult run(const std::string& program, const std::string& options) const {
    const auto path = folder_.path() / "program.nc";
    std::ofstream{path} << program;
    return test_support::run_in(
        folder_.path(), fmt::format("timeout 60 '{}' '{}' --segment {} {}", CNC_KERNEL_PROGRAM, path.string(),
                                    segment_, options));
  }

  /// A program, and the row of each of its functions in the table.
  void expect_functions_done(const std::string& options) const {
    const auto ended = run("N10 M8 G1 X5 F600\nN20 M9\nN30 M30\n", "--table " + options);
    EXPECT_EQ(ended.exit_code, 0) << ended.output;
    for (const char* const function : {"N10        M8", "N20        M9", "N30        M30"}) {
      const std::size_t row = ended.output.find(function);
      ASSERT_NE(row, std::string::npos) << function << " in " << ended.output;
      EXPECT_TRUE(ended.output.substr(row, ended.output.find('\n', row) - row).ends_with("done"))
          << ended.output;
    }
    EXPECT_NE(ended.output.find("motion: 1 feed move "), std::string::npos) << ended.output;
  }

 private:
  test_support::TemporaryFolder folder_;
  std::string segment_ = fmt::format("kernel_and_emulator_test_{}", ::getpid());
  emulator_models::EmulatorProcess emulator_{{"--segment", segment_, "--scan-period-ms", "2"}};
};

TEST_F(KernelAndEmulator, run_a_part_program_with_the_port_used_directly) { expect_functions_done(""); }

TEST_F(KernelAndEmulator, run_a_part_program_with_a_polling_thread_and_the_published_pauses) {
  expect_functions_done("--polling helper --enq-wait-ms 20 --request-wait-ms 40");
}

TEST_F(KernelAndEmulator, show_the_table_when_the_run_fails) {
  const auto ended = run("N10 S1000 M3\nN20 M8\nN30 M30\n", "--table --fin-timeout-ms 1");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("no FIN"), std::string::npos) << ended.output;
  EXPECT_NE(ended.output.find("motion: none"), std::string::npos) << ended.output;
}

}  // namespace
