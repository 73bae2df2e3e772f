// The program `ltsim`, run as a user runs it.

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/shell.hpp"

namespace {

using Result = test_support::ShellResult;

class CommandLineTest : public testing::Test {
 protected:
  [[nodiscard]] Result shell(const std::string& line) const {
    return test_support::run_in(folder_.path(), line);
  }
  [[nodiscard]] Result ltsim(const std::string& arguments) const {
    return shell(LTSIM_PROGRAM " " + arguments);
  }

  [[nodiscard]] std::string read(const char* name) const {
    std::ifstream file{folder_.path() / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  void write(const char* name, const std::string& text) const {
    std::ofstream{folder_.path() / name} << text;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(CommandLineTest, list_shows_each_scenario_with_what_it_is) {
  const Result result = ltsim("list");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* name : {"paper/one-request ", "paper/three-requests ", "paper/time-out ",
                           "paper/semaphore-reset ", "paper/late-emulator ", "nc/part-program "}) {
    EXPECT_NE(result.output.find(name), std::string::npos) << name;
  }
}

TEST_F(CommandLineTest, zoo_tells_what_each_strategy_needs_for_a_known_race_and_that_its_cure_holds) {
  const Result result = ltsim("zoo --shape races/o30-lost-bit --seeds 2 --executions 2000");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  for (const char* text : {"random", "pct", "swarm", "races/o30-lost-bit ", "  silent"})
    EXPECT_NE(result.output.find(text), std::string::npos) << result.output;
}

TEST_F(CommandLineTest, zoo_fails_when_a_known_race_is_missed_and_refuses_one_that_is_not_known) {
  const Result missed = ltsim("zoo --shape races/stale-answer-modulo-8 --seeds 1 --executions 1");
  EXPECT_EQ(missed.exit_code, 1);
  EXPECT_NE(missed.output.find(">1"), std::string::npos) << missed.output;
  EXPECT_EQ(ltsim("zoo --shape races/none-such").exit_code, 2);
}

TEST_F(CommandLineTest, exploring_a_sound_scenario_finds_nothing) {
  const Result result = ltsim("explore paper/three-requests --executions 1000");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("nothing found: 1000 executions"), std::string::npos) << result.output;
}

TEST_F(CommandLineTest, prove_says_what_was_covered) {
  const Result result = ltsim("prove paper/three-requests --out .");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.output.find("all 4512 executions with any number of preemptions and no silence"),
            std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("memory sc; 0 cut off"), std::string::npos) << result.output;
}

TEST_F(CommandLineTest, prove_finds_the_late_answer_in_a_silence_and_its_schedule_can_be_replayed) {
  const Result found =
      ltsim("prove paper/h03-stale-answer --preemptions 2 --silences 1 --minimize-seconds 0 --out .");
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_NE(found.output.find("invariant: I1: "), std::string::npos) << found.output;
  EXPECT_EQ(ltsim("replay paper-h03-stale-answer.schedule").exit_code, 1);
}

/// What a proof says that it has covered; without that, all that it says.
std::string coverage_of(const Result& result) {
  const std::size_t begin = result.output.find("  all ");
  return begin == std::string::npos ? result.output
                                    : result.output.substr(begin, result.output.rfind(", ") - begin);
}

TEST_F(CommandLineTest, a_proof_that_is_interrupted_goes_on_where_it_was) {
  const std::string command = "prove races/o02-stale-response-corrected --silences 1 --out . --preemptions ";
  const std::string whole = coverage_of(ltsim(command + "2 --anew"));
  for (const std::string jobs : {"", " --jobs 2", " --jobs 3"}) {
    const Result begun = ltsim(command + "2 --seconds 0.001" + jobs);
    EXPECT_NE(begun.output.find("no proof yet"), std::string::npos) << begun.output;
    const Result other = ltsim(command + "1" + jobs);
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_NE(other.output.find("of other bounds"), std::string::npos) << other.output;
    // However many workers the first part had.
    const Result ended = ltsim(command + "2" + (jobs.empty() ? " --jobs 2" : ""));
    EXPECT_NE(ended.output.find("goes on from"), std::string::npos) << ended.output;
    EXPECT_EQ(coverage_of(ended), whole) << jobs;
  }
}

TEST_F(CommandLineTest, what_a_proof_covers_does_not_depend_on_the_number_of_jobs) {
  for (const std::string scenario :
       {"paper/three-requests", "paper/h05b-refused-yet-executed", "paper/h09-late-emulator-corrected",
        "races/o07-lost-token-corrected", "races/weak-seqlock-even-store-corrected",
        "paper/three-requests --preemptions 1 --silences 1"}) {
    const std::string whole = coverage_of(ltsim("prove --out . " + scenario));
    EXPECT_EQ(whole.find("  all "), 0U) << whole;
    for (const std::string jobs : {" --jobs 2", " --jobs 3"})
      EXPECT_EQ(coverage_of(ltsim("prove --out . " + scenario + jobs)), whole) << scenario << jobs;
  }
}

TEST_F(CommandLineTest, a_proof_by_several_jobs_finds_the_failure_that_one_finds) {
  const std::string command =
      "prove paper/h03-stale-answer --preemptions 2 --silences 1 --minimize-seconds 0 --out .";
  EXPECT_EQ(ltsim(command).exit_code, 1);
  const std::string schedule = read("paper-h03-stale-answer.schedule");
  EXPECT_FALSE(schedule.empty());
  std::filesystem::remove(folder_.path() / "paper-h03-stale-answer.schedule");
  EXPECT_EQ(ltsim(command + " --jobs 3").exit_code, 1);
  EXPECT_EQ(read("paper-h03-stale-answer.schedule"), schedule);
}

TEST_F(CommandLineTest, a_signal_ends_a_proof_by_several_jobs_and_leaves_a_checkpoint) {
  const std::string command =
      LTSIM_PROGRAM " prove paper/three-requests --preemptions 9 --silences 9 --jobs 2 --out .";
  const Result stopped = shell("timeout --preserve-status -s INT 0.5 " + command);
  EXPECT_EQ(stopped.exit_code, 130) << stopped.output;
  EXPECT_NE(stopped.output.find("no proof yet"), std::string::npos) << stopped.output;
  const Result again = shell(command + " --seconds 0.1");
  EXPECT_EQ(again.exit_code, 0) << again.output;
  EXPECT_NE(again.output.find("goes on from"), std::string::npos) << again.output;
}

TEST_F(CommandLineTest, a_proof_whose_worker_dies_says_so_and_where_it_can_go_on) {
  const Result died = shell(DOOMED_PROGRAM " prove doomed/kills --jobs 2 --out .");
  EXPECT_EQ(died.exit_code, 3) << died.output;
  EXPECT_NE(died.output.find("a worker process died of SIGKILL"), std::string::npos) << died.output;
  EXPECT_NE(died.output.find("the same command goes on from ./doomed-kills.proof"), std::string::npos)
      << died.output;
  const Result again = shell(DOOMED_PROGRAM " prove doomed/kills --jobs 2 --out .");
  EXPECT_EQ(again.exit_code, 3) << again.output;
  EXPECT_NE(again.output.find("goes on from"), std::string::npos) << again.output;
}

TEST_F(CommandLineTest, a_checkpoint_of_another_version_is_refused) {
  write("paper-one-request.proof", "ltsim proof 1\nscenario  paper/one-request\n");
  const Result result = ltsim("prove paper/one-request --out .");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("paper-one-request.proof: is of another version of this program"),
            std::string::npos)
      << result.output;
  EXPECT_EQ(ltsim("prove paper/one-request --out . --anew").exit_code, 0);
}

TEST_F(CommandLineTest, what_prove_finds_where_points_take_no_time_is_told_and_can_be_replayed) {
  const Result found = ltsim(
      "prove hardened/m2-withdrawn-by-a-store --states --preemptions 2 --silences 1 --minimize-seconds 0 "
      "--out .");
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_NE(found.output.find("invariant: I6: "), std::string::npos) << found.output;
  EXPECT_EQ(ltsim("replay hardened-m2-withdrawn-by-a-store.schedule").exit_code, 1);
}

TEST_F(CommandLineTest, prove_tells_states_apart) {
  const Result settled = ltsim("prove races/stale-answer-modulo-1-corrected --states --silences any --out .");
  EXPECT_EQ(settled.exit_code, 0);
  EXPECT_NE(settled.output.find(" states in "), std::string::npos) << settled.output;
  EXPECT_NE(settled.output.find("any number of preemptions and any number of silences, memory sc; 0 cut off"),
            std::string::npos)
      << settled.output;
  const Result found =
      ltsim("prove races/stale-answer-modulo-1 --states --silences any --minimize-seconds 0 --out .");
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_NE(found.output.find("invariant: I1: "), std::string::npos) << found.output;
  EXPECT_EQ(ltsim("replay races-stale-answer-modulo-1.schedule").exit_code, 1);
}

TEST_F(CommandLineTest, prove_refuses_silences_that_are_no_number_or_without_end) {
  const Result no_number = ltsim("prove paper/three-requests --states --silences 1.5");
  EXPECT_EQ(no_number.exit_code, 2);
  EXPECT_NE(no_number.output.find("\"1.5\" is no whole number, nor \"any\""), std::string::npos)
      << no_number.output;
  const Result negative = ltsim("prove paper/three-requests --states --silences=-1");
  EXPECT_EQ(negative.exit_code, 2);
  const Result without_end = ltsim("prove paper/three-requests --preemptions 1 --silences any");
  EXPECT_EQ(without_end.exit_code, 2);
  EXPECT_NE(without_end.output.find("--silences any needs --states"), std::string::npos)
      << without_end.output;
}

TEST_F(CommandLineTest, prove_refuses_silences_without_a_bound_on_preemptions) {
  const Result result = ltsim("prove paper/three-requests --silences 1");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("--silences needs --preemptions"), std::string::npos) << result.output;
}

TEST_F(CommandLineTest, the_replay_line_of_a_failure_is_the_last_and_runs_as_it_is_printed) {
  const Result found = ltsim("explore paper/time-out");
  EXPECT_EQ(found.exit_code, 1);
  const std::size_t at = found.output.rfind("  replay:  ");
  ASSERT_NE(at, std::string::npos) << found.output;
  std::string line = found.output.substr(at + 11);
  ASSERT_EQ(line.find('\n'), line.size() - 1) << "the replay line is the last";
  line.pop_back();
  const Result replayed = shell(line);
  EXPECT_EQ(replayed.exit_code, 1);
  const std::string broken = found.output.substr(found.output.find("invariant: "));
  EXPECT_NE(replayed.output.find(broken.substr(0, broken.find('\n'))), std::string::npos) << replayed.output;
  const Result again = shell(line);
  EXPECT_EQ(again.output, replayed.output);
}

TEST_F(CommandLineTest, a_replay_line_with_an_awkward_path_can_be_pasted_too) {
  const Result found = ltsim("explore paper/time-out --out \"my 'own' results\"");
  const std::string line = found.output.substr(found.output.rfind("  replay:  ") + 11);
  EXPECT_EQ(shell(line.substr(0, line.find('\n'))).exit_code, 1) << line;
}

TEST_F(CommandLineTest, a_replay_that_ends_otherwise_than_recorded_says_so) {
  write("fixed.schedule",
        "ltsim schedule 1\nscenario paper/one-request\nmemory sc\noutcome invariant: I1: gone\n");
  const Result replayed = ltsim("replay fixed.schedule");
  EXPECT_EQ(replayed.exit_code, 0);
  EXPECT_NE(replayed.output.find("not as recorded: invariant: I1: gone"), std::string::npos)
      << replayed.output;
}

TEST_F(CommandLineTest, the_json_report_has_the_published_fields) {
  EXPECT_EQ(ltsim("explore paper/time-out --seed 7 --json report.json").exit_code, 1);
  const auto report = nlohmann::json::parse(read("report.json"));
  EXPECT_EQ(report.at("schema"), "ltsim.explore/1");
  EXPECT_EQ(report.at("scenario"), "paper/time-out");
  EXPECT_EQ(report.at("strategy"), "swarm");
  EXPECT_EQ(report.at("seed"), 7);
  for (const char* number : {"executions", "decisions", "seconds", "distinct_schedules"})
    EXPECT_GT(report.at(number), 0) << number;
  ASSERT_EQ(report.at("failures").size(), 1U);
  const auto& failure = report.at("failures").at(0);
  EXPECT_EQ(failure.at("kind"), "invariant");
  EXPECT_EQ(failure.at("execution"), report.at("executions"));
  EXPECT_TRUE(failure.at("seed").is_number());
  EXPECT_FALSE(failure.at("message").get<std::string>().empty());
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / failure.at("schedule").get<std::string>()));
  EXPECT_EQ(report.size(), 9U);
}

TEST_F(CommandLineTest, a_text_trace_shows_each_step_with_its_value) {
  EXPECT_EQ(ltsim("explore paper/time-out").exit_code, 1);
  EXPECT_EQ(ltsim("replay out/paper-time-out.schedule --trace text --out trace.txt").exit_code, 1);
  const std::string trace = read("trace.txt");
  EXPECT_NE(trace.find("atomic_store    segment.request[0] := 17"), std::string::npos)
      << trace.substr(0, 2000);
  EXPECT_NE(trace.find("SUBMIT 1: 11 12 13"), std::string::npos);
  EXPECT_NE(trace.find("sem_wait"), std::string::npos);
}

TEST_F(CommandLineTest, explore_makes_a_failure_small_and_tells_its_story) {
  const Result found = ltsim("explore demo/parts-counter --strategy random");
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_NE(found.output.find("minimized to 1"), std::string::npos) << found.output;
  EXPECT_NE(
      found.output.find("      -> lathe/main is stopped before its write parts.count #1; mill/main runs\n"),
      std::string::npos)
      << found.output;
  const Result replayed = ltsim("replay out/demo-parts-counter.schedule");
  const std::string story = found.output.substr(found.output.find("  story: "));
  EXPECT_NE(replayed.output.find(story.substr(0, story.find("  replay:"))), std::string::npos)
      << replayed.output;
}

TEST_F(CommandLineTest, minimize_makes_small_what_was_recorded_in_full) {
  EXPECT_EQ(ltsim("explore demo/parts-counter --strategy random --minimize-seconds 0").exit_code, 1);
  const std::string recorded = read("out/demo-parts-counter.schedule");
  EXPECT_GT(std::count(recorded.begin(), recorded.end(), '\n'), 6);
  const Result minimized = ltsim("minimize out/demo-parts-counter.schedule --out small.schedule");
  EXPECT_EQ(minimized.exit_code, 1);
  EXPECT_NE(minimized.output.find("without any one of them the failure is gone"), std::string::npos)
      << minimized.output;
  const std::string small = read("small.schedule");
  EXPECT_EQ(std::count(small.begin(), small.end(), '\n'), 5) << small;
  EXPECT_EQ(read("out/demo-parts-counter.schedule"), recorded);
  EXPECT_EQ(ltsim("replay small.schedule").exit_code, 1);
  EXPECT_EQ(ltsim("minimize out/demo-parts-counter.schedule").exit_code, 1);
  EXPECT_EQ(read("out/demo-parts-counter.schedule"), small);
}

TEST_F(CommandLineTest, an_input_that_fails_is_replayed_and_made_small_by_whole_records) {
  write("words.schedule",
        "ltsim schedule 1\nscenario fuzz/doomed-words\nmemory sc\n"
        "outcome invariant: fire and powder are kept apart\n"
        "input \"water\\n\"\ninput \"a fire\\n\"\ninput \"\\x00\\xff\\n\"\ninput \"powder and ball\"\n");
  const Result replayed = shell(DOOMED_PROGRAM " replay words.schedule");
  EXPECT_EQ(replayed.exit_code, 1) << replayed.output;
  EXPECT_NE(replayed.output.find("fuzz/doomed-words  invariant: fire and powder are kept apart"),
            std::string::npos)
      << replayed.output;
  EXPECT_EQ(replayed.output.find("not as recorded"), std::string::npos) << replayed.output;

  const Result minimized = shell(DOOMED_PROGRAM " minimize words.schedule --out small.schedule");
  EXPECT_EQ(minimized.exit_code, 1) << minimized.output;
  EXPECT_NE(minimized.output.find("4 lines, minimized to 2 in "), std::string::npos) << minimized.output;
  const std::string small = read("small.schedule");
  EXPECT_TRUE(small.ends_with("\ninput     \"fire\"\ninput     \"powder\"\n")) << small;
  EXPECT_EQ(shell(DOOMED_PROGRAM " replay small.schedule").exit_code, 1);
}

TEST_F(CommandLineTest, an_input_that_passes_says_that_it_is_not_as_recorded) {
  write(
      "words.schedule",
      "ltsim schedule 1\nscenario fuzz/doomed-words\noutcome crash: AddressSanitizer: heap-buffer-overflow\n"
      "input \"fire\\n\"\n");
  const Result result = shell(DOOMED_PROGRAM " replay words.schedule");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("not as recorded: crash: AddressSanitizer"), std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("a sanitizer found that"), std::string::npos) << result.output;
  EXPECT_EQ(shell(DOOMED_PROGRAM " minimize words.schedule").exit_code, 2);
}

TEST_F(CommandLineTest, each_fuzz_target_is_a_scenario) {
  const Result result = ltsim("list");
  for (const char* name : {"fuzz/fx-frame ", "fuzz/il-source ", "fuzz/machine-table ", "fuzz/nc-program ",
                           "fuzz/operator-script ", "fuzz/plc-config ", "fuzz/schedule-file "}) {
    EXPECT_NE(result.output.find(name), std::string::npos) << name << "\n" << result.output;
  }
}

TEST_F(CommandLineTest, a_schedule_that_no_longer_fits_is_refused_by_line) {
  write("old.schedule",
        "ltsim schedule 1\nscenario paper/one-request\nmemory sc\noutcome passed\n"
        "switch kernel/main before sem_post handoff #1 to emulator/main\n"
        "switch kernel/main before sem_post handoff #9 to emulator/main\n");
  const Result result = ltsim("replay old.schedule");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.output.find("old.schedule:6: this line no longer fits"), std::string::npos)
      << result.output;
}

TEST_F(CommandLineTest, a_failure_is_told_also_where_its_schedule_cannot_be_written) {
  const Result result = ltsim("explore paper/time-out --minimize-seconds 0 --out /proc/nowhere");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("invariant: I"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("    switch    kernel/main"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("/proc/nowhere/paper-time-out.schedule: cannot be written"),
            std::string::npos);
}

TEST_F(CommandLineTest, bad_usage_exits_with_2_and_says_what_is_wrong) {
  write("bad.schedule", "ltsim schedule 1\nscenario paper/one-request\nswich a to b\n");
  write("passes.schedule", "ltsim schedule 1\nscenario paper/one-request\noutcome invariant: I1: gone\n");
  write("foreign.schedule", "ltsim schedule 1\nscenario no/such\n");
  const struct {
    const char* arguments;
    const char* message;
  } cases[] = {
      {"", "subcommand"},
      {"explore", "scenarios"},
      {"explore paper/no-such", "there is no scenario \"paper/no-such\""},
      {"explore paper/one-request --executions 0", "--executions"},
      {"explore paper/one-request --strategy clever", "clever"},
      {"explore paper/one-request --jobs 0", "--jobs"},
      {"prove paper/one-request --jobs 0", "--jobs: Value 0 not in range 1 to 256"},
      {"prove paper/one-request --jobs 257", "--jobs: Value 257 not in range 1 to 256"},
      {"prove paper/one-request --jobs 2 --states", "--jobs cannot be with --states"},
      {"replay no-such-file", "no-such-file: cannot be read"},
      {"minimize no-such-file", "no-such-file: cannot be read"},
      {"minimize passes.schedule", "passes.schedule: does not fail as it says"},
      {"explore paper/one-request --minimize-seconds -1", "--minimize-seconds"},
      {"fuzz", "targets"},
      {"fuzz no-such", "there is no fuzz target \"no-such\"; there are: fx-device-name, fx-frame, "},
      {"fuzz fx-frame --seconds 0", "--seconds"},
      {"fuzz fx-frame --jobs 65", "--jobs"},
      {"fuzz fx-frame --source nowhere",
       "nowhere: holds no CMakePresets.json; run \"ltsim fuzz\" in the project's folder, or say --source"},
      {"replay bad.schedule", "bad.schedule:3: \"swich\""},
      {"replay foreign.schedule", "no/such"}};
  for (const auto& c : cases) {
    const Result result = ltsim(c.arguments);
    EXPECT_EQ(result.exit_code, 2) << c.arguments << "\n" << result.output;
    EXPECT_NE(result.output.find(c.message), std::string::npos) << c.arguments << "\n" << result.output;
  }
}

TEST_F(CommandLineTest, every_program_shows_a_printable_help) {
  for (const char* command :
       {LTSIM_PROGRAM " --help", LTSIM_PROGRAM " explore --help", LTSIM_PROGRAM " replay --help",
        LTSIM_PROGRAM " minimize --help", LTSIM_PROGRAM " prove --help", LTSIM_PROGRAM " fuzz --help",
        PLC_EMULATOR_PROGRAM " --help", CNC_KERNEL_PROGRAM " --help"}) {
    const Result result = shell(command);
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_GT(result.output.size(), 100U) << command;
    for (const char c : result.output) {
      ASSERT_TRUE(c == '\n' || std::isprint(static_cast<unsigned char>(c)) != 0)
          << command << ": " << static_cast<int>(c);
    }
  }
}

}  // namespace
