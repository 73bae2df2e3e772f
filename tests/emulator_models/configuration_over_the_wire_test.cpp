// Another configuration for a plc-emulator --config that runs, sent by a plc-emulator --send-config, or by hand.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "emulator_models/configuration_frames.hpp"
#include "emulator_models/soft_plc/configuration_transfer.hpp"
#include "protocol/handoff.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/role_lock.hpp"
#include "tests/emulator_models/configured_emulator_rig.hpp"
#include "tests/emulator_models/emulator_process.hpp"
#include "tests/protocol/fx/worked_examples.hpp"

namespace emulator_models {
namespace {

using protocol::fx::as_span;
using protocol::fx::examples::bytes;

/// The emulator runs plc.toml; what is to be sent is written to sent.toml.
struct ConfigurationOverTheWire : ConfiguredEmulator {
  const std::string segment = "ltsim-wire-" + std::to_string(::getpid());
  const std::string sent_path = (folder / "sent.toml").string();

  ConfigurationOverTheWire() { configure("good.il"); }

  /// As configure(), to the file that is sent.
  void write_sent(const std::string& program, int period_ms) const {
    std::stringstream running;
    running << std::ifstream{path}.rdbuf();
    configure(program, "one", period_ms);
    std::filesystem::rename(path, sent_path);
    std::ofstream{path} << running.str();
  }
  /// @return exit code and what was printed
  std::pair<int, std::string> send_over(const std::vector<std::string>& where) const {
    std::vector<std::string> words{"--send-config", sent_path};
    words.insert(words.end(), where.begin(), where.end());
    EmulatorProcess sender{words};
    const int code = sender.wait_for_exit();
    return {code, sender.printed()};
  }
  static void end(EmulatorProcess& emulator) {
    emulator.send_signal(SIGTERM);
    EXPECT_EQ(emulator.wait_for_exit(), 0);
  }
};

/// D0, which counts the scans of the first cycle.
std::vector<std::byte> count_of_scans(const SerialLine& line) {
  line.send(bytes("02 30 31 30 30 30 30 32 03 35 36"));
  return line.receive(8);
}

void expect_scans_go_on(const SerialLine& line) {
  const auto before = count_of_scans(line);
  ASSERT_EQ(before.size(), 8U);
  std::vector<std::byte> after;
  do {
    after = count_of_scans(line);
    ASSERT_EQ(after.size(), 8U);
  } while (after == before);
}

TEST_F(ConfigurationOverTheWire, is_taken_in_RUN_over_the_segment_and_over_the_line) {
  EmulatorProcess emulator{{"--config", path, "--segment", segment, "--pty"}};
  const std::string terminal = emulator.wait_for_line("pty: ");
  ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
  write_sent("good.il", 20);
  EXPECT_EQ(send_over({"--segment", segment}),
            std::pair(0, sent_path + ": taken by the PLC on segment '" + segment + "'\n"));
  EXPECT_TRUE(emulator.wait_for_text("loaded over the wire; counts from the next scan of each cycle on"));
  emulator.send_signal(SIGUSR1);
  EXPECT_TRUE(emulator.wait_for_text("cycle slow, every 20 ms: "));
  write_sent("good.il", 30);
  EXPECT_EQ(send_over({"--port", terminal}),
            std::pair(0, sent_path + ": taken by the PLC on " + terminal + "\n"));
  emulator.send_signal(SIGUSR1);
  EXPECT_TRUE(emulator.wait_for_text("cycle slow, every 30 ms: "));
  EXPECT_EQ(emulator.printed().find("STOP"), std::string::npos) << emulator.printed();
  expect_scans_go_on(SerialLine{terminal});
  end(emulator);
}

TEST_F(ConfigurationOverTheWire, goes_by_the_handoff_that_both_were_told_and_leaves_nothing) {
  write_sent("good.il", 20);
  for (const std::string handoff : {"hardened", "paper"}) {
    EmulatorProcess emulator{{"--config", path, "--segment", segment, "--protocol", handoff}};
    ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
    const auto other =
        send_over({"--segment", segment, "--protocol", handoff == "paper" ? "hardened" : "paper"});
    EXPECT_EQ(other.first, 2);
    EXPECT_NE(other.second.find("--protocol paper"), std::string::npos) << other.second;
    EXPECT_EQ(send_over({"--segment", segment, "--protocol", handoff}).first, 0);
    end(emulator);
    EXPECT_EQ(protocol::handoff_of_segment(segment), std::nullopt);
  }
}

TEST_F(ConfigurationOverTheWire, that_finds_nobody_who_serves_removes_what_is_left) {
  write_sent("good.il", 20);
  protocol::hardened::Slave slave{segment, {}};
  ASSERT_TRUE(slave.open());
  slave.close();
  const auto sent = send_over({"--segment", segment});
  EXPECT_EQ(sent.first, 2);
  EXPECT_NE(sent.second.find("was not executed"), std::string::npos) << sent.second;
  EXPECT_EQ(protocol::handoff_of_segment(segment), std::nullopt);
}

TEST_F(ConfigurationOverTheWire, a_bad_one_is_refused_whole_with_line_and_reason_and_the_old_one_goes_on) {
  EmulatorProcess emulator{{"--config", path, "--pty"}};
  const std::string terminal = emulator.wait_for_line("pty: ");
  ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
  write_sent("good.il", 20);  // a good part before the bad one
  std::ofstream{sent_path, std::ios::app} << "[archive]\nrows = 1\n";
  const auto [code, told] = send_over({"--port", terminal});
  EXPECT_EQ(code, 2);
  EXPECT_NE(told.find(sent_path + ":12:1: "), std::string::npos) << told;
  EXPECT_NE(told.find("rows"), std::string::npos) << told;
  EXPECT_FALSE(
      emulator
          .wait_for_line("plc-emulator: refused, the configuration of before goes on: over the wire:12:1: ")
          .empty());
  emulator.send_signal(SIGUSR1);
  EXPECT_TRUE(emulator.wait_for_text("cycle slow, every 10 ms: "));
  expect_scans_go_on(SerialLine{terminal});
  end(emulator);
}

TEST_F(ConfigurationOverTheWire, the_place_in_a_program_of_the_PLC_comes_back_too_however_long_its_path) {
  EmulatorProcess emulator{{"--config", path, "--pty"}};
  const std::string terminal = emulator.wait_for_line("pty: ");
  const std::string name = std::string(200, 'n') + ".il";
  write(name, "PROGRAM p\nLD 1\nnonsense 3\nEND_PROGRAM\n");
  write_sent(name, 10);
  const auto [code, told] = send_over({"--port", terminal});
  EXPECT_EQ(code, 2);
  EXPECT_NE(told.find(sent_path + ":9:"), std::string::npos) << told;
  EXPECT_NE(told.find((folder / name).string() + ":3:1: "), std::string::npos) << told;
  end(emulator);
}

TEST_F(ConfigurationOverTheWire, one_that_needs_STOP_is_refused_in_RUN_and_builds_the_PLC_anew_in_STOP) {
  EmulatorProcess emulator{{"--config", path, "--segment", segment}};
  ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
  write("other.il", "PROGRAM other\nEND_PROGRAM\n");
  write_sent("other.il", 10);
  const auto [code, told] = send_over({"--segment", segment});
  EXPECT_EQ(code, 2);
  EXPECT_NE(told.find(sent_path + ": changes the program of cycle slow, which cannot be done in RUN"),
            std::string::npos)
      << told;
  emulator.send_signal(SIGUSR2);
  ASSERT_TRUE(emulator.wait_for_text("STOP\n"));
  EXPECT_EQ(send_over({"--segment", segment}).first, 0);
  EXPECT_TRUE(emulator.wait_for_text("loaded over the wire: a new PLC, in STOP; SIGUSR2 starts it"));
  end(emulator);
}

struct ByHand {
  const SerialLine& line;

  std::optional<TransferAnswer> ask(const TransferRequest& request) const {
    line.send(as_span(encode(request)));
    protocol::fx::FrameReceiver receiver;
    for (;;) {
      const auto byte = line.receive(1);
      if (byte.empty()) return std::nullopt;
      const auto event = receiver.receive(byte[0]);
      if (event == protocol::fx::FrameReceiver::Event::nak_received) return std::nullopt;
      if (event == protocol::fx::FrameReceiver::Event::frame) return decode_transfer_answer(receiver.frame());
    }
  }
  bool begin(std::string_view text) const {
    return ask({.command = TransferCommand::begin,
                .number = soft_plc::crc32(text),
                .second = static_cast<std::uint32_t>(text.size()),
                .bytes = {}})
        ->taken;
  }
  bool chunk(std::string_view text, std::size_t offset, std::size_t count) const {
    TransferRequest request{.command = TransferCommand::chunk,
                            .number = static_cast<std::uint32_t>(offset),
                            .second = 0,
                            .bytes = {}};
    for (const char character : text.substr(offset, count))
      request.bytes.push_back(static_cast<std::byte>(character));
    return ask(request)->taken;
  }
  /// @return the reason; empty: taken
  std::string commit(std::string_view text) const {
    const auto answer =
        ask({.command = TransferCommand::commit, .number = soft_plc::crc32(text), .second = 0, .bytes = {}});
    std::string reason;
    for (const std::byte byte : answer->text) reason += static_cast<char>(byte);
    return reason;
  }
};

TEST_F(ConfigurationOverTheWire, what_is_damaged_cut_off_or_mixed_is_never_loaded) {
  EmulatorProcess emulator{{"--config", path, "--pty"}};
  const SerialLine line{emulator.wait_for_line("pty: ")};
  ASSERT_TRUE(emulator.wait_for_text("RUN\n"));
  const ByHand hand{line};
  const std::string text(300, '#');  // a comment, were it loaded
  const std::string other(300, '\n');

  // A message whose sum is wrong: NAK, and the transfer goes on with it sent again.
  ASSERT_TRUE(hand.begin(text));
  auto damaged = encode(TransferRequest{.command = TransferCommand::chunk,
                                        .number = 0,
                                        .second = 0,
                                        .bytes = protocol::fx::DataBytes(100, std::byte{'#'})});
  damaged[20] = std::byte{'0'};
  line.send(as_span(damaged));
  EXPECT_EQ(line.receive(1), std::vector{protocol::fx::nak});
  ASSERT_TRUE(hand.chunk(text, 0, 100));
  // Cut off: its client has gone.
  EXPECT_EQ(hand.commit(text), "length or sum differ from what begin has named; send all again");
  // A byte that changed on its way in spite of the message's sum.
  std::string changed = text;
  changed[200] = '!';
  ASSERT_TRUE(hand.begin(text));
  ASSERT_TRUE(hand.chunk(changed, 0, 200));
  ASSERT_TRUE(hand.chunk(changed, 200, 100));
  EXPECT_EQ(hand.commit(text), "length or sum differ from what begin has named; send all again");
  // Two clients, chunk by chunk.
  ASSERT_TRUE(hand.begin(text));
  ASSERT_TRUE(hand.begin(other));
  ASSERT_TRUE(hand.chunk(other, 0, 200));
  ASSERT_FALSE(hand.chunk(text, 0, 200));
  EXPECT_EQ(hand.commit(text), "another transfer has begun meanwhile; send all again");
  EXPECT_EQ(emulator.printed().find("over the wire"), std::string::npos) << emulator.printed();
  ASSERT_TRUE(hand.chunk(other, 200, 100));
  EXPECT_EQ(hand.commit(other).substr(0, 5), ":1:1:") << "whole, and no configuration";
  expect_scans_go_on(line);
  end(emulator);
}

TEST_F(ConfigurationOverTheWire, without_a_PLC_that_takes_it_the_sender_ends_with_2_and_says_why) {
  write_sent("good.il", 10);
  EmulatorProcess fx{{"--pty"}};
  const auto to_fx = send_over({"--port", fx.wait_for_line("pty: ")});
  EXPECT_EQ(to_fx.first, 2);
  EXPECT_NE(to_fx.second.find("no message it knows"), std::string::npos) << to_fx.second;
  const auto to_none = send_over({"--segment", segment});
  EXPECT_EQ(to_none.first, 2);
  EXPECT_NE(to_none.second.find("there is no such segment"), std::string::npos) << to_none.second;
  protocol::RoleLock kernel{segment, protocol::Role::kernel};
  ASSERT_TRUE(kernel.try_lock());
  const auto beside_kernel = send_over({"--segment", segment});
  EXPECT_EQ(beside_kernel.first, 2);
  EXPECT_NE(beside_kernel.second.find("a kernel is attached"), std::string::npos) << beside_kernel.second;
  EXPECT_EQ(send_over({}).first, 2);
  EXPECT_EQ(send_over({"--port", "/dev/null", "--segment", segment}).first, 2);
  EXPECT_EQ(send_over({"--port", "/dev/null"}).first, 2);
  std::filesystem::remove(sent_path);
  EXPECT_NE(send_over({"--port", "/dev/null"}).second.find("cannot be read"), std::string::npos);
}

}  // namespace
}  // namespace emulator_models
