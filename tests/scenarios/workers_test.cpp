// What a user sees when executions kill or hang their process, when a signal ends the search, and when there is
// nowhere to write to.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/shell.hpp"

namespace {

using Result = test_support::ShellResult;

class WorkersTest : public testing::Test {
 protected:
  [[nodiscard]] Result shell(const std::string& line) const {
    return test_support::run_in(folder_.path(), line);
  }
  [[nodiscard]] Result doomed(const std::string& arguments) const {
    return shell(DOOMED_PROGRAM " explore doomed/" + arguments);
  }
  [[nodiscard]] std::string read(const char* name) const {
    std::ifstream file{folder_.path() / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  /// The JSON report, without what depends on time.
  [[nodiscard]] nlohmann::json timeless_report() const {
    auto report = nlohmann::json::parse(read("report.json"));
    report.erase("seconds");
    return report;
  }

  static bool contains(const Result& result, const std::string& text) {
    return result.output.find(text) != std::string::npos;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(WorkersTest, a_killed_worker_is_reported_with_its_execution_and_a_line_that_kills_one_again) {
  const Result result = doomed("kills --keep-going --executions 1000 --jobs 2");
  EXPECT_EQ(result.exit_code, 1);
  const std::size_t begin = result.output.find("doomed/kills  crash: worker died of SIGKILL\n  execution ");
  ASSERT_NE(begin, std::string::npos) << result.output;
  const std::string death = result.output.substr(begin, result.output.find(';', begin) - begin);
  const std::size_t at = result.output.find("  again:  ", begin);
  ASSERT_NE(at, std::string::npos) << result.output;
  const std::string line = result.output.substr(at + 10, result.output.find('\n', at) - at - 10);
  const Result again = shell(line);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_TRUE(contains(again, death)) << line << "\n" << again.output;
}

TEST_F(WorkersTest, what_is_found_before_and_after_a_death_is_reported_too) {
  for (const char* jobs : {"1", "3"}) {
    const Result result =
        doomed("kills --keep-going --executions 1000 --json report.json --jobs " + std::string{jobs});
    EXPECT_EQ(result.exit_code, 1);
    const auto report = timeless_report();
    EXPECT_EQ(report.at("executions"), 1000);
    ASSERT_EQ(report.at("failures").size(), 2U) << result.output;
    for (const auto& failure : report.at("failures")) {
      const bool died = failure.at("kind") == "crash";
      EXPECT_EQ(failure.at("schedule").is_null(), died) << failure;
      EXPECT_FALSE(failure.contains("schedule_text"));
    }
  }
}

TEST_F(WorkersTest, equal_seeds_and_jobs_give_equal_reports_whatever_dies) {
  for (const char* strategy : {"random", "swarm"}) {
    for (const char* jobs : {"1", "3"}) {
      const std::string line =
          std::string{"kills --keep-going --executions 500 --json report.json --strategy "} + strategy +
          " --jobs " + jobs;
      const Result first = doomed(line);
      const auto report = timeless_report();
      const Result second = doomed(line);
      EXPECT_EQ(first.output, second.output);
      EXPECT_EQ(report, timeless_report());
    }
  }
}

TEST_F(WorkersTest, an_execution_without_scheduling_points_is_killed_and_reported) {
  const Result result = doomed("hangs --hang-seconds 1");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result, "doomed/hangs  livelock: no scheduling point for 1 s")) << result.output;
}

TEST_F(WorkersTest, an_interrupted_search_reports_what_it_has_found) {
  const Result result = doomed("interrupts --keep-going --seconds 60 --json report.json --junit report.xml");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result, "invariant: eight")) << result.output;
  EXPECT_TRUE(contains(result, "  replay:  ")) << result.output;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/doomed-interrupts.schedule"));
  EXPECT_EQ(timeless_report().at("failures").size(), 1U);
  EXPECT_LT(timeless_report().at("executions"), 1'000'000'000);
  EXPECT_NE(read("report.xml").find("</testsuites>"), std::string::npos);
}

TEST_F(WorkersTest, a_search_that_is_stopped_without_a_finding_exits_as_the_signal_has_it) {
  const Result result = doomed("terminates --seconds 60");
  EXPECT_EQ(result.exit_code, 143);
  EXPECT_TRUE(contains(result, "nothing found before the interruption: ")) << result.output;
}

TEST_F(WorkersTest, an_interruption_ends_the_scenarios_that_were_to_come_as_well) {
  const Result result = doomed("terminates doomed/hangs --seconds 60");
  EXPECT_EQ(result.exit_code, 143);
  EXPECT_FALSE(contains(result, "doomed/hangs")) << result.output;
}

TEST_F(WorkersTest, what_is_not_simulated_exits_with_3_but_not_before_the_failures_found_are_told) {
  const Result result = doomed("calls-fork --keep-going --json report.json");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result, "invariant: even")) << result.output;
  EXPECT_TRUE(contains(result, "ltsim: p/main called fork")) << result.output;
  const auto report = timeless_report();
  EXPECT_EQ(report.at("failures").size(), 1U);
  EXPECT_NE(report.at("error").get<std::string>().find("fork"), std::string::npos);
}

TEST_F(WorkersTest, a_failure_is_told_in_full_where_its_schedule_cannot_be_written) {
  std::filesystem::create_directory(folder_.path() / "out");
  std::filesystem::create_symlink("/dev/full", folder_.path() / "out/doomed-interrupts.schedule");
  const Result result = doomed("interrupts --json /dev/stdout");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result, "    choose    ")) << result.output;
  EXPECT_TRUE(contains(result, "cannot be written: No space left on device")) << result.output;
  EXPECT_TRUE(contains(result, R"("schedule": null)")) << result.output;
  EXPECT_TRUE(contains(result, R"("schedule_text": "ltsim schedule 1\n)")) << result.output;
}

TEST_F(WorkersTest, a_report_for_which_the_disk_is_full_does_not_hide_that_something_was_found) {
  const Result result = doomed("interrupts --json /dev/full");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(contains(result, "/dev/full: cannot be written: No space left on device")) << result.output;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/doomed-interrupts.schedule"));
  EXPECT_EQ(doomed("terminates --executions 5 --junit /dev/full").exit_code, 2);
}

TEST_F(WorkersTest, the_json_report_of_several_scenarios_is_an_array_in_their_order) {
  EXPECT_EQ(doomed("interrupts doomed/terminates --executions 100 --json report.json").exit_code, 1);
  const auto reports = nlohmann::json::parse(read("report.json"));
  ASSERT_EQ(reports.size(), 2U);
  EXPECT_EQ(reports.at(0).at("scenario"), "doomed/interrupts");
  EXPECT_EQ(reports.at(1).at("scenario"), "doomed/terminates");
  for (const auto& report : reports) EXPECT_EQ(report.at("schema"), "ltsim.explore/1");
}

TEST_F(WorkersTest, the_junit_report_is_well_formed_xml_whatever_a_message_holds) {
  EXPECT_EQ(doomed("kills doomed/terminates --keep-going --executions 1000 --junit report.xml").exit_code, 1);
  const std::string xml = read("report.xml");
  EXPECT_NE(xml.find(R"(<testsuite name="doomed/kills" tests="2" failures="2" errors="0" )"),
            std::string::npos)
      << xml;
  EXPECT_NE(xml.find(R"(<testsuite name="doomed/terminates" tests="1" failures="0" errors="0" )"),
            std::string::npos)
      << xml;
  EXPECT_NE(xml.find("message=\"eight, and &lt;&quot;&amp;&apos;&gt; ?\xef\xbf\xbd\""), std::string::npos)
      << xml;
  if (shell("command -v xmllint").exit_code != 0) GTEST_SKIP() << "there is no xmllint to parse it with";
  const Result parsed = shell("xmllint --noout report.xml");
  EXPECT_EQ(parsed.exit_code, 0) << parsed.output;
}

}  // namespace
