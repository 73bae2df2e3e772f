// Both sides at once, as they run in the field: two threads, two processes, and a process that is killed. Time-outs are
// too long to matter here; what they do is shown in worlds (worlds_test.cpp).

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "protocol/hardened/slave.hpp"
#include "protocol/shared_memory_port.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"
#include "tests/protocol/two_sides.hpp"

namespace protocol::hardened {
namespace {

using namespace std::chrono_literals;

Options patient(Options::Doorbells doorbells = Options::Doorbells::two) {
  Options options;
  options.doorbells = doorbells;
  options.take_timeout = 60s;
  options.answer_timeout = 60s;
  options.poll_interval = 1us;
  return options;
}

class TwoHardenedSides : public testing::TestWithParam<Options::Doorbells> {};

TEST_P(TwoHardenedSides, exchange_a_thousand_requests_as_two_threads) {
  const HardenedSegment segment;
  Slave slave(segment.name(), patient(GetParam()));
  ASSERT_TRUE(slave.open());
  std::jthread emulator([&slave] { answer_until_stopped(slave); });
  SharedMemoryPort port(segment.name(), patient(GetParam()));
  ASSERT_TRUE(port.open());
  port.set_timeouts({.read = 60s, .write = 60s});
  EXPECT_EQ(ask_in_turn(port, 1000), -1);
  slave.request_stop();
}

Slave* stopped_by_signal = nullptr;

/// The emulator's process: serves until SIGTERM.
[[noreturn]] void run_emulator(const std::string& segment_name, const Options& options, int ready) {
  {
    Slave slave(segment_name, options);
    if (!slave.open()) ::_exit(1);
    stopped_by_signal = &slave;
    struct sigaction stop = {};
    stop.sa_handler = [](int) { stopped_by_signal->request_stop(); };
    ::sigaction(SIGTERM, &stop, nullptr);
    static_cast<void>(::write(ready, "1", 1));
    answer_until_stopped(slave);
  }
  ::_exit(0);
}

/// Forks it, and returns when it serves.
pid_t start_emulator(const std::string& segment_name, const Options& options) {
  int ready[2];
  EXPECT_EQ(::pipe(ready), 0);
  const pid_t emulator = ::fork();
  if (emulator == 0) run_emulator(segment_name, options, ready[1]);
  char opened = 0;
  EXPECT_EQ(::read(ready[0], &opened, 1), 1);
  ::close(ready[0]);
  ::close(ready[1]);
  return emulator;
}

TEST_P(TwoHardenedSides, exchange_a_thousand_requests_as_two_processes_and_end_on_a_signal) {
  const HardenedSegment segment;
  const pid_t emulator = start_emulator(segment.name(), patient(GetParam()));
  SharedMemoryPort port(segment.name(), patient(GetParam()));
  ASSERT_TRUE(port.open());
  EXPECT_EQ(ask_in_turn(port, 1000), -1);
  ASSERT_EQ(::kill(emulator, SIGTERM), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(emulator, &status, 0), emulator);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(segment.word().phase, Phase::down);
}

TEST_P(TwoHardenedSides, go_on_after_the_emulator_was_killed_and_started_again) {
  const HardenedSegment segment;
  const pid_t first = start_emulator(segment.name(), patient(GetParam()));
  SharedMemoryPort port(segment.name(), patient(GetParam()));
  ASSERT_TRUE(port.open());
  EXPECT_EQ(ask_in_turn(port, 10), -1);
  ASSERT_EQ(::kill(first, SIGKILL), 0);
  ASSERT_EQ(::waitpid(first, nullptr, 0), first);
  const pid_t second = start_emulator(segment.name(), patient(GetParam()));
  EXPECT_EQ(ask_in_turn(port, 10), -1);
  ASSERT_EQ(::kill(second, SIGKILL), 0);
  ASSERT_EQ(::waitpid(second, nullptr, 0), second);
}

INSTANTIATE_TEST_SUITE_P(Doorbells, TwoHardenedSides,
                         testing::Values(Options::Doorbells::two, Options::Doorbells::one),
                         [](const auto& tested) {
                           return tested.param == Options::Doorbells::two ? "two" : "one";
                         });

}  // namespace
}  // namespace protocol::hardened
