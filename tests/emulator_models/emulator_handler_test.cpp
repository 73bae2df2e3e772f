// The loop of the emulator over a real segment, with a PLC that the test sees.
#include "emulator_models/emulator_handler.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>
#include <vector>

#include "emulator_models/fx_plc_emulator.hpp"
#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/fx/worked_examples.hpp"
#include "tests/protocol/test_segment.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::examples::bytes;

protocol::PaperOptions patient() {
  protocol::PaperOptions options;
  options.read_timeout = 1min;  // a busy host must not look like a silent PLC
  return options;
}

struct EmulatorHandlerTest : ::testing::Test {
  protocol::TestSegment segment;
  protocol::SlaveSharedMemoryWrapper slave{segment.name(), patient()};
  protocol::MasterSharedMemoryWrapper master{segment.name(), patient()};
  FxPlcEmulator plc{protocol::fx::Model::fx3u};
  EmulatorHandler handler{slave, plc};
  std::thread thread;

  void SetUp() override {
    ASSERT_TRUE(slave.open().has_value());
    ASSERT_TRUE(master.open().has_value());
    thread = std::thread{[this] { handler.run(); }};
  }
  void TearDown() override {
    handler.request_stop();
    if (thread.joinable()) thread.join();
  }

  std::vector<std::byte> ask(std::string_view hex) {
    EXPECT_TRUE(master.write(bytes(hex)).has_value());
    std::array<std::byte, 600> answer{};
    const auto count = master.get_response(answer);
    EXPECT_TRUE(count.has_value());
    return {answer.begin(), answer.begin() + static_cast<std::ptrdiff_t>(count.value_or(0))};
  }
};

TEST_F(EmulatorHandlerTest, answers_request_after_request) {
  EXPECT_EQ(ask("05"), bytes("06"));
  EXPECT_EQ(ask("02 31 31 30 46 36 30 34 33 34 31 32 43 44 41 42 03 34 39"), bytes("06"));
  EXPECT_EQ(ask("02 30 31 30 46 36 30 34 03 37 34"), bytes("02 33 34 31 32 43 44 41 42 03 44 37"));
  EXPECT_EQ(ask("02 30 31 30 46 36 30 34 03 37 35"), bytes("15"));
}

TEST_F(EmulatorHandlerTest, silence_of_the_plc_is_an_empty_response) {
  EXPECT_TRUE(ask("30 31 32").empty());
  EXPECT_EQ(ask("05"), bytes("06"));
}

TEST_F(EmulatorHandlerTest, a_stop_ends_the_wait_for_a_request) {
  handler.request_stop();
  thread.join();  // or the test hangs
}

}  // namespace
}  // namespace emulator_models
