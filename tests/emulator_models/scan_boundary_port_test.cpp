// Requests that wait for the scan boundary. What waits is known by the queue's bound, never by a pause.
#include "emulator_models/scan_boundary_port.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/fx_plc_loop.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "tests/emulator_models/soft_plc/il_rig.hpp"
#include "tests/protocol/fx/worked_examples.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Model;
using protocol::fx::examples::bytes;

std::vector<std::byte> answer_to(IPlcEmulator& port, const char* request) {
  const auto answer = port.process(bytes(request));
  const auto view = protocol::fx::as_span(answer);
  return {view.begin(), view.end()};
}

constexpr const char* write_d123_d124 = "02 31 31 30 46 36 30 34 33 34 31 32 43 44 41 42 03 34 39";
constexpr const char* read_d123_d124 = "02 30 31 30 46 36 30 34 03 37 34";
constexpr const char* enq = "05";

TEST(ScanBoundaryPort, a_request_that_nobody_serves_is_given_up_and_never_executed) {  // I1
  FxPlcEmulator plc{Model::fx3u};
  plc.lock()->set(watchdog_time, 1);
  ScanBoundaryPort port{plc, 1ms};
  const auto request =
      bytes(write_d123_d124);  // outlives the wait: a port that held on to it would execute it
  EXPECT_TRUE(protocol::fx::as_span(port.process(request)).empty());
  port.serve(plc.lock());
  EXPECT_EQ(plc.read_word({protocol::fx::DeviceKind::d, 123}), 0U);
}

TEST(ScanBoundaryPort, what_waits_at_the_end_is_executed_and_what_comes_later_met_with_silence) {
  FxPlcEmulator plc{Model::fx3u};
  ScanBoundaryPort port{plc, 1h};
  std::atomic<bool> answered = false;
  std::thread client{[&] {
    EXPECT_EQ(answer_to(port, enq), bytes("06"));
    answered = true;
  }};
  while (!answered) port.serve(plc.lock());
  client.join();
  port.close(plc.lock());
  EXPECT_TRUE(answer_to(port, enq).empty());
}

TEST(ScanBoundaryPort, one_request_more_than_may_wait_is_met_with_silence) {
  FxPlcEmulator plc{Model::fx3u};
  ScanBoundaryPort port{plc, 1h};
  std::atomic<std::size_t> silent = 0;
  std::atomic<std::size_t> acknowledged = 0;
  std::vector<std::thread> clients;
  for (std::size_t i = 0; i <= ScanBoundaryPort::waiting_max; ++i)
    clients.emplace_back([&] { ++(answer_to(port, enq).empty() ? silent : acknowledged); });
  // Nobody is served yet: the one answer that comes is the silence of the one too many.
  while (silent == 0) std::this_thread::yield();
  EXPECT_EQ(acknowledged, 0U);
  port.serve(plc.lock());
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(silent, 1U);
  EXPECT_EQ(acknowledged, ScanBoundaryPort::waiting_max);
}

TEST(ScanBoundaryPort, a_request_sees_whole_scans_only) {
  FxPlcEmulator plc{Model::fx3u};
  ScanBoundaryPort port{plc, 1h};
  // Within a scan the two words differ, at its end they are equal.
  const auto program = soft_plc::compile(
      soft_plc::program_of(
          "a AT D123 : INT; b AT D124 : INT; n AT D0 : INT;",
          "LD a\nADD 1\nST a\nLD 200\nST n\nmore: LD n\nSUB 1\nST n\nGT 0\nJMPC more\nLD a\nST b"),
      FxAddressMap{Model::fx3u});
  ASSERT_TRUE(program.has_value()) << to_string(program.error());
  FxPlcConfig config;
  config.period = 0ns;
  config.watchdog_limit = 30s;  // a busy host is no fault here
  config.slice_instructions = 50;
  FxPlc scanned{plc, *program, {}, &port, config, std::chrono::steady_clock::now()};
  FxPlcLoop loop{scanned};
  std::thread scan{[&] { loop.run(); }};
  for (int i = 0; i < 100; ++i) {
    const auto answer = answer_to(port, read_d123_d124);
    EXPECT_EQ(answer.size(), 12U);
    if (answer.size() != 12U) break;
    EXPECT_TRUE(std::equal(answer.begin() + 1, answer.begin() + 5, answer.begin() + 5));
  }
  loop.request_stop();
  scan.join();
}

TEST(FxPlcLoop, tells_of_a_fault_and_of_its_end_once_each_and_ends_when_asked) {
  FxPlcEmulator plc{Model::fx3u};
  const auto program = soft_plc::compile(
      soft_plc::program_of("hang AT M0 : BOOL;", "here: LD hang\nJMPC here"), FxAddressMap{Model::fx3u});
  ASSERT_TRUE(program.has_value());
  FxPlcConfig config;
  config.period = 1ms;
  config.scan_instructions_max = 1000;
  FxPlc scanned{plc, *program, {}, nullptr, config, std::chrono::steady_clock::now()};
  std::atomic<int> faults = 0;
  std::atomic<int> ends = 0;
  FxPlcLoop loop{scanned, [&](const FxPlc& told) { ++(told.fault() ? faults : ends); }};
  std::thread scan{[&] { loop.run(); }};
  for (int round = 1; round <= 3; ++round) {
    plc.lock()->set({protocol::fx::DeviceKind::m, 0}, 1);
    while (faults < round) std::this_thread::yield();
    EXPECT_EQ(ends, round - 1);
    {
      const auto memory = plc.lock();
      memory->set({protocol::fx::DeviceKind::m, 0}, 0);
      memory->set({protocol::fx::DeviceKind::m, 8035}, 1);
      memory->set({protocol::fx::DeviceKind::m, 8036}, 1);
    }
    while (ends < round) std::this_thread::yield();
    EXPECT_EQ(faults, round);
  }
  loop.request_stop();
  scan.join();
}

}  // namespace
}  // namespace emulator_models
