// plc-emulator --config as a process of its own: its start, its signals, its faults, its end.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "tests/emulator_models/archive/archive_rig.hpp"
#include "tests/emulator_models/configured_emulator_rig.hpp"
#include "tests/emulator_models/emulator_process.hpp"
#include "tests/protocol/fx/worked_examples.hpp"

namespace emulator_models {
namespace {

using protocol::fx::examples::bytes;

/// Sends a read of one word until it is not zero.
void wait_until_not_zero(const SerialLine& line, const char* read) {
  std::vector<std::byte> answer;
  do {
    line.send(bytes(read));
    answer = line.receive(8);
    ASSERT_EQ(answer.size(), 8U);
  } while (answer == bytes("02 30 30 30 30 03 43 33"));
}

TEST_F(ConfiguredEmulator, runs_for_the_time_asked_for_and_prints_the_starts_of_each_cycle) {
  configure("good.il");
  EmulatorProcess emulator{{"--config", path, "--seconds", "1"}};
  EXPECT_EQ(emulator.wait_for_exit(), 0);
  EXPECT_NE(emulator.printed().find("\nRUN\n"), std::string::npos) << emulator.printed();
  EXPECT_NE(emulator.printed().find("cycle fast, every 1 ms: "), std::string::npos);
  EXPECT_NE(emulator.printed().find("cycle slow, every 10 ms: "), std::string::npos);
  EXPECT_NE(emulator.printed().find("start late by"), std::string::npos);
}

TEST_F(ConfiguredEmulator, sigterm_and_sigint_end_it_cleanly) {
  configure("good.il", "per-cycle");
  for (const int signal : {SIGTERM, SIGINT}) {
    EmulatorProcess emulator{{"--config", path}};
    ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
    emulator.send_signal(signal);
    EXPECT_EQ(emulator.wait_for_exit(), 0);
  }
}

// I20, in real time.
TEST_F(ConfiguredEmulator, an_endless_loop_is_stopped_by_the_watchdog_and_told) {
  write("loop.il", "PROGRAM loop\nagain:\nJMP again\nEND_PROGRAM\n");
  for (const char* const threads : {"one", "per-cycle"}) {
    configure("loop.il", threads);
    EmulatorProcess emulator{{"--config", path}};
    EXPECT_TRUE(emulator.wait_for_text("alarm lamp on, outputs are safe"));
    EXPECT_TRUE(emulator.wait_for_text("fault in cycle slow: watchdog (1)")) << emulator.printed();
    emulator.send_signal(SIGTERM);
    EXPECT_EQ(emulator.wait_for_exit(), 0);
    EXPECT_NE(emulator.printed().find("fault in cycle fast: stopped (4)"), std::string::npos);
  }
}

TEST_F(ConfiguredEmulator, a_run_time_fault_is_told_with_file_line_and_column_and_the_switch_starts_anew) {
  // Divides by zero half a second after its start.
  write("divides.il",
        "PROGRAM divides\nVAR n : INT; t : TON; END_VAR\nCAL t(IN := TRUE, PT := T#500ms)\n"
        "LD t.Q\nJMPCN done\nLD 1\nDIV n\nST n\ndone:\nEND_PROGRAM\n");
  configure("divides.il");
  EmulatorProcess emulator{{"--config", path}};
  EXPECT_EQ(emulator.wait_for_line((folder / "divides.il").string() + ":"), "7:1: division by zero");
  emulator.send_signal(SIGUSR2);
  EXPECT_TRUE(emulator.wait_for_text("alarm lamp off")) << emulator.printed();
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST_F(ConfiguredEmulator, sighup_takes_a_period_in_RUN_and_refuses_a_bad_file_with_its_place) {
  configure("good.il");
  EmulatorProcess emulator{{"--config", path}};
  ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
  write("plc.toml", "[plc]\nthread = 1\n");
  emulator.send_signal(SIGHUP);
  EXPECT_EQ(emulator.wait_for_line("plc-emulator: refused, the configuration of before goes on: " + path)
                .substr(0, 6),
            ":2:1: ");
  configure("good.il", "one", 20);
  emulator.send_signal(SIGHUP);
  EXPECT_TRUE(emulator.wait_for_text("loaded again; counts from the next scan"));
  write("other.il", "PROGRAM other\nEND_PROGRAM\n");
  configure("other.il", "one", 20);
  emulator.send_signal(SIGHUP);
  EXPECT_TRUE(emulator.wait_for_text("changes the program of cycle slow, which cannot be done in RUN"));
  emulator.send_signal(SIGUSR2);
  EXPECT_TRUE(emulator.wait_for_text("STOP\n"));
  emulator.send_signal(SIGHUP);
  EXPECT_TRUE(emulator.wait_for_text("loaded again: a new PLC, in STOP"));
  emulator.send_signal(SIGUSR1);
  EXPECT_TRUE(emulator.wait_for_text("cycle slow, every 20 ms: 0 scans begun"));
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST_F(ConfiguredEmulator, the_programming_port_shows_words_of_the_first_cycle) {
  configure("good.il");
  EmulatorProcess emulator{{"--config", path, "--pty"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  wait_until_not_zero(line, "02 30 31 30 30 30 30 32 03 35 36");  // D0 counts scans
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST_F(ConfiguredEmulator, the_report_shows_the_real_time_data_of_each_cycle_all_of_one_scan) {
  // Both words are equal after each scan.
  write(
      "twins.il",
      "PROGRAM twins\nVAR a AT %MW0 : INT; b AT %MW1 : INT; END_VAR\nLD a\nADD 1\nST a\nST b\nEND_PROGRAM\n");
  configure("twins.il", "per-cycle");
  std::ofstream{path, std::ios::app} << "[realtime_data]\nsignals = [\"%MW0\", \"%MW1\"]\n";
  EmulatorProcess emulator{{"--config", path, "--seconds", "1"}};
  ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
  emulator.send_signal(SIGUSR1);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
  EXPECT_NE(emulator.printed().find("\nvalues of cycle fast after scan "), std::string::npos)
      << emulator.printed();
  const std::regex twins{
      "values of cycle slow after scan [1-9][0-9]*, at [0-9.]+ s: "
      "%MW0 = ([1-9][0-9]*) .16#[0-9A-F]{4}., %MW1 = ([0-9]+) "};
  std::sregex_iterator line{emulator.printed().begin(), emulator.printed().end(), twins};
  ASSERT_NE(line, std::sregex_iterator{}) << emulator.printed();
  for (; line != std::sregex_iterator{}; ++line) EXPECT_EQ((*line)[1], (*line)[2]);
}

TEST_F(ConfiguredEmulator, the_filling_station_of_the_example_fills_bottles) {
  EmulatorProcess emulator{{"--config", EXAMPLE_CONFIGURATION, "--pty"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  wait_until_not_zero(line, "02 30 31 30 31 32 30 32 03 35 39");  // D9 counts them
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
  EXPECT_EQ(emulator.printed().find("fault"), std::string::npos) << emulator.printed();
}

TEST_F(ConfiguredEmulator, the_archive_of_the_configuration_has_what_both_cycles_did) {
  write("blinks.il", "PROGRAM blinks\nVAR y AT %QX0.3 : BOOL; END_VAR\nLDN y\nST y\nEND_PROGRAM\n");
  for (const std::string threads : {"one", "per-cycle"}) {
    configure("blinks.il", threads);
    const std::string name = threads + ".archive";
    std::ofstream{path, std::ios::app} << "[archive]\npath = \"" << name
                                       << "\"\nrows_max = 1000\nsignals = [\"%QX0.3\"]\n";
    EmulatorProcess emulator{{"--config", path, "--pty"}};
    const SerialLine line{emulator.wait_for_line("pty: ")};
    wait_until_not_zero(line, "02 30 31 30 30 30 30 32 03 35 36");
    archive::OtherConnection query{folder / name};
    const char* const blinked =
        "SELECT count(*) > 10 FROM signal_changes WHERE cycle = 1 AND signal = '%QX0.3'";
    for (int looks = 0; looks < 1000 && query(blinked) != "1 "; ++looks)
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    EXPECT_EQ(query(blinked), "1 ") << "ten seconds later";
    emulator.send_signal(SIGTERM);
    EXPECT_EQ(emulator.wait_for_exit(), 0);
    EXPECT_NE(emulator.printed().find("rows stored, 0 records lost"), std::string::npos)
        << emulator.printed();
    EXPECT_EQ(query("SELECT DISTINCT cycle FROM scans WHERE scans_count > 0 ORDER BY cycle"), "0 1 ");
    EXPECT_EQ(query("SELECT cycle, what FROM history WHERE event = 'mode' AND what = 'RUN' ORDER BY cycle"),
              "0 RUN 1 RUN ");
    EXPECT_EQ(query("SELECT DISTINCT cycle FROM signal_changes"), "1 ");
  }
}

TEST_F(ConfiguredEmulator, the_archive_names_program_file_line_and_column_of_a_fault) {
  write("divides.il", "PROGRAM divides\nVAR n : INT; END_VAR\nLD 1\n  DIV n\nEND_PROGRAM\n");
  configure("divides.il");
  std::ofstream{path, std::ios::app} << "[archive]\npath = \"plc.archive\"\n";
  EmulatorProcess emulator{{"--config", path}};
  EXPECT_TRUE(emulator.wait_for_text("fault in cycle slow: program failed (3)")) << emulator.printed();
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
  archive::OtherConnection query{folder / "plc.archive"};
  const std::string place = (folder / "divides.il").string() + ":4:3";
  EXPECT_EQ(query("SELECT cycle, place FROM faults WHERE fault = 'program failed'"), "1 " + place + " ");
  EXPECT_EQ(query("SELECT count(*) FROM faults WHERE cycle = 0 AND place IS NOT NULL"), "0 ");
  EXPECT_EQ(query("SELECT what FROM history WHERE event = 'fault' AND cycle = 1"),
            "program failed in execute at " + place + " ");
}

TEST_F(ConfiguredEmulator, an_archive_that_cannot_be_had_refuses_the_configuration_at_its_line) {
  configure("good.il");
  std::ofstream{path, std::ios::app} << "[archive]\npath = \"missing/plc.archive\"\n";
  EmulatorProcess emulator{{"--config", path}};
  EXPECT_EQ(emulator.wait_for_exit(), 2);
  EXPECT_NE(emulator.printed().find(path + ":12:8: "), std::string::npos) << emulator.printed();
  EXPECT_NE(emulator.printed().find("missing/plc.archive"), std::string::npos) << emulator.printed();
}

TEST_F(ConfiguredEmulator, bad_usage_and_bad_files_are_2) {
  configure("none.il");
  const std::vector<std::vector<std::string>> uses{{"--config", path},
                                                   {"--config", (folder / "none.toml").string()},
                                                   {"--config", path, "--model", "FX2N"},
                                                   {"--config", path, "--watch"},
                                                   {"--config", path, "--seconds", "0"},
                                                   {"--pty", "--seconds", "3"}};
  for (const auto& use : uses) {
    EmulatorProcess emulator{use};
    EXPECT_EQ(emulator.wait_for_exit(), 2) << emulator.printed();
    EXPECT_NE(emulator.printed(), "");
  }
}

}  // namespace
}  // namespace emulator_models
