// What the program cnc-kernel does about a request that was not executed, and about one that may have been. The test is the
// emulator: a slave of the hardened handoff that ends at a chosen request, as one that is killed does, and another one that
// comes after it.
#include <algorithm>
#include <array>
#include <atomic>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "protocol/fx/frame.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/kernel_mocks/scripted_plc.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"
#include "tests/support/shell.hpp"

namespace kernel_mocks {
namespace {

using protocol::fx::Command;
using protocol::fx::Request;
using protocol::hardened::Slave;

/// The addresses of the legacy map: M n at 0100H + n/8, D n at 1000H + 2n.
bool writes_m_code(const Request& request) {
  return request.command == Command::write && request.address == 0x1000 + 2 * 100 &&
         request.data.front() == std::byte{8};
}
bool raises_mf(const Request& request) {
  return request.command == Command::write && request.address == 0x0100 + 96 / 8 &&
         (request.data.front() & std::byte{0x10}) != std::byte{0};
}
bool reads_status(const Request& request) {
  return request.command == Command::read && request.address == 0x0100 + 120 / 8;
}

class CncKernelOutcomes : public testing::Test {
 protected:
  using Which = std::function<bool(const Request&)>;

  /// Runs M8 M30.
  [[nodiscard]] test_support::ShellResult run_kernel(const std::string& options) const {
    std::ofstream{folder_.path() / "program.nc"} << "N10 M8\nN20 M30\n";
    return test_support::run_in(
        folder_.path(), fmt::format("timeout 60 '{}' program.nc --segment {} --read-timeout-ms 20000 {}",
                                    CNC_KERNEL_PROGRAM, segment_.name(), options));
  }

  /// Answers all that comes, up to the first request that is `last`.
  /// @return whether it came; false: stopped
  bool serve_until(Slave& slave, const Which& last, bool answers_it) {
    while (slave.wait_for_request()) {
      const auto frame = slave.read_request();
      const auto request = protocol::fx::decode_request(frame);  // ENQ is none
      if (request) executed_.push_back(*request);
      const bool is_last = request && last(*request);
      if (is_last && !answers_it) return true;
      std::array<std::byte, protocol::fx::frame_bytes_max> answer{};
      static_cast<void>(plc_.write(frame));
      slave.write_response(std::span{answer}.first(plc_.read(answer).value_or(0)));
      if (is_last) return true;
    }
    return false;
  }

  /// Runs the kernel against a slave that ends, and one that comes after it.
  test_support::ShellResult run_with(const std::function<bool(Slave&)>& serve_first,
                                     const std::string& options) {
    Slave first{segment_.name(), {}};
    Slave second{segment_.name(), {}};
    // Before the kernel looks for a PLC. The roles are the thread's that takes them.
    std::atomic<bool> is_open = false;
    std::thread emulator{[&] {
      EXPECT_TRUE(first.open());
      is_open = true;
      is_open.notify_one();
      const bool ended_so = serve_first(first);
      first.close();
      if (!ended_so) return;
      EXPECT_TRUE(second.open());
      serve_until(second, [](const Request&) { return false; }, true);
      second.close();
    }};
    is_open.wait(false);
    auto ended = run_kernel(options);
    first.request_stop();
    second.request_stop();
    emulator.join();
    return ended;
  }

  /// As a killed one: what it has taken stays taken.
  test_support::ShellResult run_with_one_that_dies_before_its_answer_to(const Which& request,
                                                                        const std::string& options) {
    return run_with([&](Slave& first) { return serve_until(first, request, false); }, options);
  }
  /// The request after that one is there, and nobody takes it.
  test_support::ShellResult run_with_one_that_ends_after(const Which& request, const std::string& options) {
    return run_with(
        [&](Slave& first) {
          if (!serve_until(first, request, true)) return false;
          while (segment_.word().phase != protocol::hardened::Phase::request) std::this_thread::yield();
          return true;
        },
        options);
  }
  [[nodiscard]] auto executed(const Which& which) const { return std::ranges::count_if(executed_, which); }

  test_support::TemporaryFolder folder_;
  protocol::hardened::HardenedSegment segment_;
  ScriptedPlc plc_;
  std::vector<Request> executed_;
};

/// A busy machine is no reason for a repetition.
const std::string patient = "--take-timeout-ms 20000";

constexpr const char* in_doubt =
    "cnc-kernel: in doubt: write 1 byte from M96 on: the one that had taken the message ended, or was "
    "started anew, "
    "before it answered. It may have been executed, and is not sent again: look what the machine has done, "
    "and reset "
    "it before the next program\n";

TEST_F(CncKernelOutcomes,
       stops_and_tells_the_request_when_a_strobe_may_have_been_seen_and_does_not_repeat_it) {
  for (const std::string polling : {"direct", "helper"}) {
    executed_.clear();
    const auto ended =
        run_with_one_that_dies_before_its_answer_to(raises_mf, patient + " --polling " + polling);
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.output.find("block N10 (line 1), M8: the link to the PLC failed: "), std::string::npos)
        << ended.output;
    EXPECT_TRUE(ended.output.ends_with(in_doubt)) << ended.output;
    EXPECT_EQ(executed(raises_mf), 1);
    EXPECT_EQ(plc_.log.back(), "M104 off") << "the reset after it has reached the PLC";
  }
}

TEST_F(CncKernelOutcomes, repeats_a_read_that_may_have_been_executed_and_goes_on) {
  const auto ended = run_with_one_that_dies_before_its_answer_to(reads_status, patient);
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  EXPECT_EQ(ended.output.find("in doubt"), std::string::npos) << ended.output;
  EXPECT_NE(ended.output.find(" 1 retries, 1 time-outs"), std::string::npos) << ended.output;
}

TEST_F(CncKernelOutcomes, repeats_a_strobe_that_was_not_executed_and_goes_on) {
  // The next slave has so many times 20 ms to come.
  const auto ended = run_with_one_that_ends_after(writes_m_code, "--take-timeout-ms 20 --retries 1000");
  EXPECT_EQ(ended.exit_code, 0) << ended.output;
  EXPECT_EQ(ended.output.find(" 0 retries"), std::string::npos) << ended.output;
  EXPECT_EQ(executed(writes_m_code), 1);
  EXPECT_EQ(executed(raises_mf), 2) << "M8 and M30";
}

TEST_F(CncKernelOutcomes, removes_the_segment_when_the_emulator_has_ended_before_it) {
  const auto ended = run_with(
      [&](Slave& first) {
        static_cast<void>(serve_until(first, raises_mf, true));
        return false;
      },
      "--take-timeout-ms 300 --retries 1");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("the PLC did not take the request, which was not executed"), std::string::npos)
      << ended.output;
  EXPECT_FALSE(protocol::hardened::segment_exists(segment_.name()));
}

}  // namespace
}  // namespace kernel_mocks
