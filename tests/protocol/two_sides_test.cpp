// Both sides at once, as they run in the field: two threads, and two processes. Inside the envelope in which
// the published design is sound (no time-out fires, nobody is killed, fresh objects, one thread a side) every
// request gets its own answer.

#include <thread>

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include "protocol/shared_memory_port.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/test_segment.hpp"
#include "tests/protocol/two_sides.hpp"

namespace protocol {
namespace {

using namespace std::chrono_literals;

/// Waits long enough for any machine and looks often enough for a quick test.
PaperOptions patient_options() {
  PaperOptions options;
  options.read_timeout = 60s;
  options.poll_interval = 1us;
  return options;
}

TEST(TwoThreads, exchange_a_thousand_requests) {
  const TestSegment segment;
  SlaveSharedMemoryWrapper slave(segment.name(), patient_options());
  ASSERT_TRUE(slave.open());
  std::jthread emulator([&slave] { answer_until_stopped(slave); });
  SharedMemoryPort port(segment.name(), patient_options());
  ASSERT_TRUE(port.open());
  EXPECT_EQ(ask_in_turn(port, 1000), -1);
  slave.request_stop();
}

TEST(TwoThreads, agree_on_the_objects_when_both_make_them_at_once) {
  for (int round = 0; round < 100; ++round) {
    const TestSegment segment;
    SlaveSharedMemoryWrapper slave(segment.name(), patient_options());
    std::jthread emulator([&slave] {
      ASSERT_TRUE(slave.open());
      answer_until_stopped(slave);
    });
    SharedMemoryPort port(segment.name(), patient_options());
    ASSERT_TRUE(port.open());
    EXPECT_EQ(ask_in_turn(port, 3), -1);
    slave.request_stop();
  }
}

SlaveSharedMemoryWrapper* stopped_by_signal = nullptr;

/// The emulator's process: serves until SIGTERM.
[[noreturn]] void run_emulator(const std::string& segment_name) {
  SlaveSharedMemoryWrapper slave(segment_name, patient_options());
  if (!slave.open()) ::_exit(1);
  stopped_by_signal = &slave;
  struct sigaction stop = {};
  stop.sa_handler = [](int) { stopped_by_signal->request_stop(); };
  ::sigaction(SIGTERM, &stop, nullptr);
  answer_until_stopped(slave);
  ::_exit(0);
}

TEST(TwoProcesses, exchange_a_thousand_requests_and_end_on_a_signal) {
  const TestSegment segment;
  const pid_t emulator = ::fork();
  ASSERT_GE(emulator, 0);
  if (emulator == 0) run_emulator(segment.name());

  SharedMemoryPort port(segment.name(), patient_options());
  ASSERT_TRUE(port.open());
  EXPECT_EQ(ask_in_turn(port, 1000), -1);
  ASSERT_EQ(::kill(emulator, SIGTERM), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(emulator, &status, 0), emulator);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(take_all_tokens(segment.name()), 0u);
}

}  // namespace
}  // namespace protocol
