// The real program, from another process: the worked examples on a pseudo-terminal, byte for byte, and what
// it leaves behind.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <optional>

#include "protocol/handoff.hpp"
#include "protocol/hardened/endpoint.hpp"
#include "protocol/role_lock.hpp"
#include "protocol/shared_memory_wrapper.hpp"
#include "tests/emulator_models/archive/archive_rig.hpp"
#include "tests/emulator_models/emulator_process.hpp"
#include "tests/protocol/fx/worked_examples.hpp"

namespace emulator_models {
namespace {

using protocol::SharedMemoryWrapper;
using protocol::fx::examples::bytes;

struct Dialogue {
  const char* what;
  const char* request;
  const char* answer;
};

/// Sends a request, takes the answer, then makes sure that nothing follows it: the ACK to an ENQ comes next.
void expect_dialogue(const SerialLine& line, const Dialogue& dialogue) {
  SCOPED_TRACE(dialogue.what);
  const auto wanted = bytes(dialogue.answer);
  line.send(bytes(dialogue.request));
  EXPECT_EQ(line.receive(wanted.size()), wanted);
  line.send(bytes("05"));
  EXPECT_EQ(line.receive(1), bytes("06"));
}

/// The examples that each model answers alike.
constexpr Dialogue common_dialogues[] = {
    {"ENQ", "05", "06"},
    {"read Y0-Y17: nothing moves", "02 30 30 30 41 30 30 32 03 36 36", "02 30 30 30 30 03 43 33"},
    {"read Y0-Y7", "02 30 30 30 41 30 30 31 03 36 35", "02 30 30 03 36 33"},
    {"write D8000 = 300", "02 31 30 45 30 30 30 32 32 43 30 31 03 34 31", "06"},
    {"force Y0 on", "02 37 30 30 30 35 03 46 46", "06"},
    {"force Y0 off", "02 38 30 30 30 35 03 30 30", "06"},
    {"force M100 off", "02 38 36 34 30 38 03 30 44", "06"},
    {"force S0 on", "02 37 30 30 30 30 03 46 41", "06"},
    {"read T10", "02 30 30 38 31 34 30 32 03 36 32", "02 30 30 30 30 03 43 33"},
    {"parameters", "02 30 38 30 30 30 32 45 03 37 32", "15"},
    {"end of program write", "02 42 03 34 35", "15"},
};

/// Of FX1N and up: FX1S has neither the devices nor the E commands, and no machine tool at its terminals.
constexpr Dialogue larger_dialogues[] = {
    {"write D123, D124", "02 31 31 30 46 36 30 34 33 34 31 32 43 44 41 42 03 34 39", "06"},
    {"read D123, D124", "02 30 31 30 46 36 30 34 03 37 34", "02 33 34 31 32 43 44 41 42 03 44 37"},
    {"read C200", "02 30 30 43 30 30 30 34 03 36 41", "02 30 30 30 30 30 30 30 30 03 38 33"},
    {"force Y20 on", "02 37 31 30 30 35 03 30 30", "06"},
};

constexpr Dialogue fx1n_dialogues[] = {
    {"D8001", "02 30 30 45 30 32 30 32 03 36 43", "02 36 32 36 36 03 44 37"},
    {"run state", "02 45 30 30 30 31 43 30 30 31 03 44 44", "02 30 39 03 36 43"},
};
constexpr Dialogue fx1s_dialogues[] = {
    {"D8001", "02 30 30 45 30 32 30 32 03 36 43", "02 43 32 35 36 03 45 33"},
    {"wide read D0", "02 45 30 30 34 30 30 30 30 32 03 43 45", "15"},
};
constexpr Dialogue fx2n_dialogues[] = {
    {"D8001", "02 30 30 45 30 32 30 32 03 36 43", "02 42 31 35 45 03 46 30"},
};
constexpr Dialogue fx3u_dialogues[] = {
    {"D8001", "02 30 30 45 30 32 30 32 03 36 43", "02 42 31 35 45 03 46 30"},
    {"D8101", "02 30 30 45 43 41 30 32 03 38 45", "02 37 31 33 46 03 45 34"},
    {"wide read D0", "02 45 30 30 34 30 30 30 30 32 03 43 45", "02 30 30 30 30 03 43 33"},
    {"wide write D100 = 258", "02 45 31 30 34 30 43 38 30 32 30 32 30 31 03 41 44", "06"},
    {"wide read D8127", "02 45 30 30 38 30 46 45 30 32 03 46 44", "02 30 30 30 30 03 43 33"},
    {"wide force M0 on", "02 45 37 30 30 34 30 03 34 33", "06"},
    {"wide force M0 off", "02 45 38 30 30 34 30 03 34 34", "06"},
    {"wide force Y0 on", "02 45 37 30 30 35 45 03 35 39", "06"},
};

/// Asks until the answer is the one of the dialogue.
void wait_for(const SerialLine& line, const Dialogue& dialogue) {
  SCOPED_TRACE(dialogue.what);
  const auto wanted = bytes(dialogue.answer);
  std::vector<std::byte> answer;
  do {
    line.send(bytes(dialogue.request));
    answer = line.receive(wanted.size());
    ASSERT_EQ(answer.size(), wanted.size());
  } while (answer != wanted);
}

constexpr Dialogue in_run{"M8000-M8007 in RUN", "02 30 30 31 45 30 30 31 03 36 41", "02 30 39 03 36 43"};
constexpr Dialogue in_stop{"M8000-M8007 in STOP", "02 30 30 31 45 30 30 31 03 36 41", "02 30 41 03 37 34"};
constexpr Dialogue machine_stands{"read X0-X17: spindle stands, chuck clamped, door closed and locked",
                                  "02 30 30 30 38 30 30 32 03 35 44", "02 30 32 31 41 03 44 37"};
constexpr Dialogue nothing_wired{"read X0-X17: no machine", "02 30 30 30 38 30 30 32 03 35 44",
                                 "02 30 30 30 30 03 43 33"};

void expect_worked_examples(const std::string& model, std::span<const Dialogue> dialogues) {
  EmulatorProcess emulator{{"--pty", "--model", model}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  wait_for(line, in_run);
  wait_for(line, model == "FX1S" ? nothing_wired : machine_stands);
  for (const Dialogue& dialogue : common_dialogues) expect_dialogue(line, dialogue);
  if (model != "FX1S")
    for (const Dialogue& dialogue : larger_dialogues) expect_dialogue(line, dialogue);
  for (const Dialogue& dialogue : dialogues) expect_dialogue(line, dialogue);

  line.send(bytes("02 30 31 30 30 30 34 30 03 35 38"));  // 64 bytes from D0
  EXPECT_EQ(line.receive(132).size(), 132U);
  expect_dialogue(line, {"force M100 on", "02 37 36 34 30 38 03 30 43", "06"});
  expect_dialogue(line, {"force M8037 on: STOP", "02 37 32 35 30 46 03 31 37", "06"});
  wait_for(line, in_stop);

  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST(PlcEmulatorPty, fx1s_answers_its_worked_examples) { expect_worked_examples("FX1S", fx1s_dialogues); }
TEST(PlcEmulatorPty, fx1n_answers_its_worked_examples) { expect_worked_examples("FX1N", fx1n_dialogues); }
TEST(PlcEmulatorPty, fx2n_answers_its_worked_examples) { expect_worked_examples("FX2N", fx2n_dialogues); }
TEST(PlcEmulatorPty, fx3u_answers_its_worked_examples) { expect_worked_examples("fx3u", fx3u_dialogues); }

TEST(PlcEmulatorPty, a_cut_off_frame_is_dropped_by_enq_and_by_stx) {
  EmulatorProcess emulator{{"--pty"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  expect_dialogue(line, {"ENQ after half a frame", "02 30 31 30 05", "06"});
  expect_dialogue(line, {"STX after half a frame", "02 30 31 30 02 37 30 30 30 35 03 46 46", "06"});
  expect_dialogue(line, {"noise between frames", "30 41 0D 0A 02 37 30 30 30 35 03 46 46", "06"});
}

TEST(PlcEmulatorPty, two_requests_at_once_are_answered_in_their_order) {
  EmulatorProcess emulator{{"--pty"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  expect_dialogue(line,
                  {"D8101, then force Y0", "02 30 30 45 43 41 30 32 03 38 45 02 37 30 30 30 35 03 46 46",
                   "02 37 31 33 46 03 45 34 06"});
}

TEST(PlcEmulatorPty, the_next_client_finds_the_line_as_the_first_did) {
  EmulatorProcess emulator{{"--pty"}};
  const std::string path = emulator.wait_for_line("pty: ");
  for (int client = 0; client < 3; ++client) {
    const SerialLine line{path};
    expect_dialogue(line, {"ENQ", "05", "06"});
  }
}

TEST(PlcEmulatorPty, watch_prints_a_line_for_each_change) {
  EmulatorProcess emulator{{"--pty", "--watch"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  expect_dialogue(line, {"force M0 on", "02 45 37 30 30 34 30 03 34 33", "06"});
  EXPECT_TRUE(emulator.wait_for_text("M0         0 -> 1"));
  emulator.send_signal(SIGINT);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
}

TEST(PlcEmulatorArchive, what_the_plc_did_and_what_the_port_wrote_stands_in_the_file_when_it_has_ended) {
  const test_support::TemporaryFolder folder;
  const auto file = folder.path() / "plc.archive";
  EmulatorProcess emulator{
      {"--pty", "--archive", file, "--archive-signals", "M0,S0", "--archive-rows", "1000"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  wait_for(line, in_run);
  expect_dialogue(line, {"force S0 on", "02 37 30 30 30 30 03 46 41", "06"});
  wait_for(line, in_run);
  emulator.send_signal(SIGTERM);
  EXPECT_EQ(emulator.wait_for_exit(), 0);
  EXPECT_NE(emulator.printed().find(", 0 records lost"), std::string::npos) << emulator.printed();
  archive::OtherConnection query{file};
  EXPECT_EQ(query("SELECT area, address, bytes, first_bytes FROM port_writes"), "2 0 1 0000000000000001 ");
  EXPECT_EQ(query("SELECT signal, before, after FROM signal_changes WHERE signal = 'S0'"), "S0 0 1 ");
  EXPECT_EQ(query("SELECT what FROM history WHERE event = 'mode'"), "RUN ");
}

/// With either handoff.
struct PlcEmulatorSegment : ::testing::TestWithParam<protocol::Handoff> {
  const std::string segment = "ltsim-test-emulator-" + std::to_string(::getpid());
  ~PlcEmulatorSegment() override {
    SharedMemoryWrapper::remove(segment);
    static_cast<void>(protocol::hardened::remove_segment(segment));
  }
  [[nodiscard]] std::vector<std::string> arguments(
      std::optional<protocol::Handoff> handoff = std::nullopt) const {
    return {"--segment", segment, "--protocol", std::string{name_of(handoff.value_or(GetParam()))}};
  }
  [[nodiscard]] static protocol::Handoff other() {
    return GetParam() == protocol::Handoff::paper ? protocol::Handoff::hardened : protocol::Handoff::paper;
  }
  /// An emulator that is killed while it serves.
  void leave_over(protocol::Handoff handoff) const {
    EmulatorProcess killed{arguments(handoff)};
    ASSERT_EQ(killed.wait_for_line("segment: "), segment);
    killed.send_signal(SIGKILL);
    EXPECT_EQ(killed.wait_for_exit(), -SIGKILL);
    EXPECT_EQ(protocol::handoff_of_segment(segment), handoff);
  }
  /// What the system has under names of this segment.
  [[nodiscard]] std::vector<std::string> named_objects() const {
    std::vector<std::string> names;
    for (const char* const folder : {"/dev/shm", "/tmp"}) {
      for (const auto& file : std::filesystem::directory_iterator{folder}) {
        const std::string name = file.path().filename();
        if (name.find(segment) != std::string::npos) names.push_back(name);
      }
    }
    return names;
  }
};

TEST_P(PlcEmulatorSegment, sigterm_and_sigint_end_the_wait_and_leave_no_named_object) {
  for (const int signal : {SIGTERM, SIGINT}) {
    auto words = arguments();
    words.emplace_back("--pty");
    EmulatorProcess emulator{words};
    ASSERT_EQ(emulator.wait_for_line("segment: "), segment);
    EXPECT_EQ(protocol::handoff_of_segment(segment), GetParam());
    emulator.send_signal(signal);
    EXPECT_EQ(emulator.wait_for_exit(), 0);
    EXPECT_EQ(named_objects(), std::vector<std::string>{});
  }
}

TEST_P(PlcEmulatorSegment, what_a_killed_emulator_left_is_removed_with_a_message_whichever_handoff_it_had) {
  for (const protocol::Handoff killed : {protocol::Handoff::paper, protocol::Handoff::hardened}) {
    leave_over(killed);
    EmulatorProcess fresh{arguments()};
    EXPECT_NE(fresh.wait_for_line("plc-emulator: removed what a killed process left"), "");
    EXPECT_EQ(fresh.wait_for_line("segment: "), segment);
    fresh.send_signal(SIGTERM);
    EXPECT_EQ(fresh.wait_for_exit(), 0);
    EXPECT_EQ(named_objects(), std::vector<std::string>{});
  }
}

TEST_P(PlcEmulatorSegment, an_emulator_that_comes_back_joins_the_segment_of_a_running_kernel) {
  protocol::RoleLock kernel{segment, protocol::Role::kernel};
  ASSERT_TRUE(kernel.try_lock().has_value());
  leave_over(GetParam());
  EmulatorProcess again{arguments()};
  EXPECT_EQ(again.wait_for_line("segment: "), segment);
  EXPECT_NE(again.printed().find("joined"), std::string::npos);
  again.send_signal(SIGTERM);
  EXPECT_EQ(again.wait_for_exit(), 0);
  EXPECT_NE(again.printed().find("a kernel is still attached"), std::string::npos);
}

TEST_P(PlcEmulatorSegment, the_segment_of_a_running_kernel_with_the_other_handoff_is_refused) {
  protocol::RoleLock kernel{segment, protocol::Role::kernel};
  ASSERT_TRUE(kernel.try_lock().has_value());
  leave_over(other());
  EmulatorProcess refused{arguments()};
  EXPECT_EQ(refused.wait_for_exit(), 2);
  EXPECT_NE(refused.printed().find("give --protocol " + std::string{name_of(other())}), std::string::npos)
      << refused.printed();
  EXPECT_EQ(protocol::handoff_of_segment(segment), other());
}

TEST_P(PlcEmulatorSegment, a_second_emulator_is_refused_and_the_first_one_goes_on) {
  EmulatorProcess first{arguments()};
  ASSERT_EQ(first.wait_for_line("segment: "), segment);
  for (const protocol::Handoff handoff : {protocol::Handoff::paper, protocol::Handoff::hardened}) {
    EmulatorProcess second{arguments(handoff)};
    EXPECT_EQ(second.wait_for_exit(), 2);
    EXPECT_NE(second.printed().find("another emulator"), std::string::npos);
    EXPECT_EQ(protocol::handoff_of_segment(segment), GetParam());
  }
  first.send_signal(SIGTERM);
  EXPECT_EQ(first.wait_for_exit(), 0);
}

INSTANTIATE_TEST_SUITE_P(Handoff, PlcEmulatorSegment,
                         ::testing::Values(protocol::Handoff::hardened, protocol::Handoff::paper),
                         [](const auto& handoff) { return std::string{name_of(handoff.param)}; });

TEST(PlcEmulatorUsage, help_is_0_and_bad_usage_is_2) {
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
  } uses[] = {{{"--help"}, 0},
              {{}, 2},
              {{"--pty", "--model", "FX9"}, 2},
              {{"--pty", "--scan-period-ms", "0"}, 2},
              {{"--pty", "--protocol", "paper", "--length-check", "maybe"}, 2},
              {{"--pty", "--length-check", "none"}, 2},
              {{"--pty", "--protocol", "maybe"}, 2},
              {{"--pty", "--archive", "/nowhere/plc.archive"}, 2},
              {{"--pty", "--archive-signals", "Y0"}, 2},
              {{"--pty", "--archive", "/nowhere/plc.archive", "--archive-signals", "Y8"}, 2},
              {{"--nonsense"}, 2}};
  for (const auto& use : uses) {
    EmulatorProcess emulator{use.arguments};
    EXPECT_EQ(emulator.wait_for_exit(), use.exit_code);
    EXPECT_NE(emulator.printed(), "");
  }
}

}  // namespace
}  // namespace emulator_models
