#include "sim_clock/scenario/interrupt.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace ltsim {
namespace {

using namespace std::chrono_literals;

TEST(InterruptGuardTest, takes_signals_that_come_together_for_one_request) {
  const InterruptGuard guard;
  EXPECT_EQ(InterruptGuard::signal(), 0);
  raise(SIGTERM);
  raise(SIGINT);
  raise(SIGTERM);
  EXPECT_EQ(InterruptGuard::signal(), SIGTERM);
}

TEST(InterruptGuardTest, lets_a_later_signal_end_the_program) {
  EXPECT_EXIT(
      {
        const InterruptGuard guard;
        raise(SIGTERM);
        std::this_thread::sleep_for(1100ms);
        raise(SIGINT);
        std::this_thread::sleep_for(1min);
      },
      testing::KilledBySignal(SIGINT), "");
}

TEST(InterruptGuardTest, leaves_what_was_there_before) {
  for (int round = 0; round < 2; ++round) {
    const InterruptGuard guard;
    EXPECT_EQ(InterruptGuard::signal(), 0);
    raise(SIGINT);
  }
  EXPECT_EXIT(raise(SIGINT), testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace ltsim
