// What a failing property prints: lines that, pasted, show the same counterexample again.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "sim_clock/explore/schedule.hpp"
#include "tests/support/shell.hpp"

namespace property_tests {
namespace {

using test_support::run_in;
using test_support::ShellResult;

std::string fails(const std::string& name) {
  return std::string{FAILING_PROPERTY} + " --gtest_filter=FailsOnPurpose." + name;
}

/// What stands behind `head` in a line of the output; empty if there is no such line.
std::string line_behind(const std::string& output, const std::string& head) {
  const std::size_t at = output.find("\n" + head);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + 1 + head.size();
  return output.substr(begin, output.find('\n', begin) - begin);
}

/// From "Falsifiable" on, without the count of cases and the lines to paste.
std::string counterexample(const std::string& output) {
  const std::size_t begin = output.find("\n\n", output.find("Falsifiable"));
  return output.substr(begin, output.find("again:") - begin);
}

class FailingProperty : public testing::Test {
 protected:
  test_support::TemporaryFolder folder;
};

TEST_F(FailingProperty, is_the_same_in_each_run_and_as_small_as_can_be) {
  const ShellResult first = run_in(folder.path(), fails("no_number_is_above_9"));
  const ShellResult second = run_in(folder.path(), fails("no_number_is_above_9"));
  EXPECT_EQ(first.exit_code, 1) << first.output;
  EXPECT_NE(first.output.find("(10)"), std::string::npos) << first.output;
  EXPECT_EQ(counterexample(first.output), counterexample(second.output));
  EXPECT_EQ(line_behind(first.output, "again:   "), line_behind(second.output, "again:   "));
}

TEST_F(FailingProperty, prints_a_line_that_runs_the_one_counterexample_again) {
  const ShellResult failed = run_in(folder.path(), fails("*"));
  const std::string line = line_behind(failed.output, "again:   ");
  ASSERT_TRUE(line.starts_with("RC_PARAMS=")) << failed.output;
  const ShellResult again = run_in(folder.path(), line);
  EXPECT_EQ(again.exit_code, 1) << again.output;
  EXPECT_NE(again.output.find("Falsifiable after 1 tests"), std::string::npos) << again.output;
  EXPECT_EQ(counterexample(again.output), counterexample(failed.output));
}

TEST_F(FailingProperty, writes_its_bytes_as_a_schedule_and_prints_the_line_that_replays_it) {
  const ShellResult failed = run_in(folder.path(), fails("no_bytes_hold_a_stx"));
  const std::filesystem::path file =
      folder.path() / "out/property-FailsOnPurpose.no_bytes_hold_a_stx.schedule";
  std::ifstream stream{file};
  const auto schedule = ltsim::parse_schedule(std::string{std::istreambuf_iterator<char>{stream}, {}});
  ASSERT_TRUE(schedule) << failed.output;
  EXPECT_EQ(schedule->scenario, "fuzz/fx-frame");
  EXPECT_EQ(schedule->input, (std::vector<std::string>{"aaa", "aa\x02\x30\x61"}));
  const std::string line = line_behind(failed.output, "replay:  ");
  ASSERT_TRUE(line.ends_with(file.string())) << failed.output;
  // The codec is as it should be: the target takes the bytes and passes.
  const ShellResult replayed = run_in(folder.path(), line);
  EXPECT_EQ(replayed.exit_code, 0) << replayed.output;
  EXPECT_NE(replayed.output.find("passed"), std::string::npos) << replayed.output;
}

}  // namespace
}  // namespace property_tests
