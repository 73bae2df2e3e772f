// cnc-kernel against plc-emulator: two real processes over real shared memory, with either handoff.
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <future>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "protocol/handoff.hpp"
#include "tests/emulator_models/emulator_process.hpp"
#include "tests/support/shell.hpp"

namespace {

using protocol::Handoff;

class KernelAndEmulator : public testing::TestWithParam<Handoff> {
 protected:
  KernelAndEmulator() { start_emulator(); }
  ~KernelAndEmulator() override {
    if (emulator_) end_emulator();
    EXPECT_EQ(protocol::handoff_of_segment(segment_), std::nullopt) << "what two programs left";
  }

  void start_emulator() {
    emulator_.emplace(std::vector<std::string>{"--segment", segment_, "--scan-period-ms", "2", "--watch",
                                               "--protocol", std::string{name_of(GetParam())}});
    EXPECT_EQ(emulator_->wait_for_line("segment: "), segment_);
  }
  void end_emulator() {
    emulator_->send_signal(SIGTERM);
    EXPECT_EQ(emulator_->wait_for_exit(), 0);
    emulator_.reset();
  }
  void kill_emulator() {
    emulator_->send_signal(SIGKILL);
    EXPECT_EQ(emulator_->wait_for_exit(), -SIGKILL);
    emulator_.reset();
  }
  void wait_until_program_runs() { ASSERT_TRUE(emulator_->wait_for_text("M104       0 -> 1")); }

  [[nodiscard]] test_support::ShellResult run(const std::string& program, const std::string& options,
                                              const std::string& run_by = "timeout 60",
                                              Handoff handoff = GetParam()) const {
    const auto path = folder_.path() / "program.nc";
    std::ofstream{path} << program;
    return test_support::run_in(
        folder_.path(), fmt::format("{} '{}' '{}' --segment {} --protocol {} {}", run_by, CNC_KERNEL_PROGRAM,
                                    path.string(), segment_, name_of(handoff), options));
  }
  [[nodiscard]] auto start(const std::string& program) const {
    return std::async(std::launch::async, [this, program] { return run(program, ""); });
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

  test_support::TemporaryFolder folder_;
  std::string segment_ = fmt::format("kernel_and_emulator_test_{}", ::getpid());
  std::optional<emulator_models::EmulatorProcess> emulator_;
};

/// What does not depend on the handoff.
class KernelAndHardenedEmulator : public KernelAndEmulator {};

constexpr const char* long_program = "N10 G4 P60\nN20 M30\n";

TEST_P(KernelAndEmulator, run_a_part_program_with_the_port_used_directly) { expect_functions_done(""); }

TEST_P(KernelAndHardenedEmulator, run_a_part_program_with_a_polling_thread_and_the_published_pauses) {
  expect_functions_done("--polling helper --enq-wait-ms 20 --request-wait-ms 40");
}

TEST_P(KernelAndHardenedEmulator, show_the_table_when_the_run_fails) {
  const auto ended = run("N10 S1000 M3\nN20 M8\nN30 M30\n", "--table --fin-timeout-ms 1");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("no FIN"), std::string::npos) << ended.output;
  EXPECT_NE(ended.output.find("motion: none"), std::string::npos) << ended.output;
}

TEST_P(KernelAndEmulator, of_different_handoffs_do_not_meet_and_say_so) {
  const bool paper = GetParam() == Handoff::paper;
  const auto ended = run("M30\n", "", "timeout 60", paper ? Handoff::hardened : Handoff::paper);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find(paper ? "it has the published handoff. Give --protocol paper"
                                    : "it has the hardened handoff. Leave out --protocol paper"),
            std::string::npos)
      << ended.output;
}

TEST_P(KernelAndEmulator, with_a_kernel_that_was_killed_run_the_next_one) {
  EXPECT_EQ(run(long_program, "", "timeout -s KILL 0.7").exit_code, 128 + SIGKILL);
  const auto ended = run("M30\n", "");
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
}

TEST_P(KernelAndEmulator, with_an_emulator_that_was_killed_stop_and_leave_nothing_that_hinders_the_next_one) {
  auto kernel = start(long_program);
  wait_until_program_runs();
  kill_emulator();
  const auto stopped = kernel.get();
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_NE(stopped.output.find("the link to the PLC failed"), std::string::npos) << stopped.output;
  start_emulator();
}

TEST_P(KernelAndEmulator, with_an_emulator_that_was_killed_and_started_again_at_once_stop) {
  auto kernel = start(long_program);
  wait_until_program_runs();
  kill_emulator();
  start_emulator();
  const auto stopped = kernel.get();
  EXPECT_EQ(stopped.exit_code, 1);
  // The memory of the next PLC says so, or a request was on its way when the first one died.
  EXPECT_TRUE(stopped.output.find("emergency stop") != std::string::npos ||
              stopped.output.find("the link to the PLC failed") != std::string::npos)
      << stopped.output;
}

TEST_P(KernelAndEmulator, with_an_emulator_that_ends_first_leave_nothing) {
  auto kernel = start(long_program);
  wait_until_program_runs();
  end_emulator();
  EXPECT_EQ(kernel.get().exit_code, 1);
}

INSTANTIATE_TEST_SUITE_P(Handoff, KernelAndEmulator, testing::Values(Handoff::hardened, Handoff::paper),
                         [](const auto& handoff) { return std::string{name_of(handoff.param)}; });

INSTANTIATE_TEST_SUITE_P(Handoff, KernelAndHardenedEmulator, testing::Values(Handoff::hardened),
                         [](const auto& handoff) { return std::string{name_of(handoff.param)}; });

}  // namespace
