// The link whose port one auxiliary thread uses: turns, ages, time-outs, shutdown.
#include "kernel_mocks/polled_link.hpp"

#include <thread>

#include <fmt/format.h>

#include "kernel_mocks/nc_parser.hpp"
#include "kernel_mocks/plc_signals.hpp"
#include "tests/kernel_mocks/simulated/simulated_kernel.hpp"

namespace kernel_mocks {
namespace {

using Clock = std::chrono::steady_clock;
using Log = std::vector<std::string>;

constexpr PlcLink::Device flag(std::uint16_t m) { return {protocol::fx::DeviceKind::m, m}; }

class PolledLinkTest : public SimulatedKernel {
 protected:
  /// Runs `use` with a link, whose options and driver a test may change before.
  void with_link(const std::function<void(PolledLink&)>& use) {
    in_world([&] {
      FxDriver driver{plc.port, driver_options};
      PolledLink link{driver, options};
      use(link);
    });
  }

  /// Each request lasts `duration` on the line, the polls too.
  void make_requests_last(std::chrono::nanoseconds duration) {
    plc.port.scan = [duration](ScriptedPlc&) { std::this_thread::sleep_for(duration); };
  }

  FxDriverOptions driver_options{.retries = 0};
  PolledLinkOptions options{};
};

TEST_F(PolledLinkTest, polls_at_its_interval) {
  with_link([](PolledLink&) { std::this_thread::sleep_for(52ms); });
  EXPECT_EQ(plc.port.polls, 11U);
}

TEST_F(PolledLinkTest, the_status_is_that_of_the_last_poll_with_its_time) {
  with_link([&](PolledLink& link) {
    std::this_thread::sleep_for(2ms);
    const auto begin = Clock::now();
    plc.port.set_bit(120, true);
    const auto old = link.status();
    ASSERT_TRUE(old.has_value());
    EXPECT_EQ(old->signals & signals::fin, std::byte{0}) << "the status was read before FIN came";
    EXPECT_LT(old->read_at, begin);
    EXPECT_LT(Clock::now() - begin, 1ms) << "status() does not wait for the line";
  });
}

TEST_F(PolledLinkTest, the_age_of_the_status_is_bounded_by_the_interval_and_the_exchanges) {
  make_requests_last(12ms);
  with_link([&](PolledLink& link) {
    for (unsigned look = 0; look < 100; ++look) {
      std::this_thread::sleep_for(3ms);
      const auto status = link.status();
      ASSERT_TRUE(status.has_value());
      // A poll that lasts, the interval, and the next poll, which has not ended yet.
      EXPECT_LE(Clock::now() - status->read_at, 12ms + 5ms + 12ms + 1ms);
    }
  });
}

TEST_F(PolledLinkTest, requests_do_not_keep_the_thread_from_polling) {
  make_requests_last(4ms);
  with_link([&](PolledLink& link) {
    for (std::uint16_t m = 0; m < 100; ++m) ASSERT_TRUE(link.force(flag(m), true).has_value());
    // One poll behind each two requests: the interval is 5 ms.
    EXPECT_GE(plc.port.polls, 40U);
  });
}

TEST_F(PolledLinkTest, reads_what_a_direct_link_reads) {
  plc.port.set_word(120, 17);
  with_link([&](PolledLink& link) { EXPECT_EQ(link.read_word(signals::alarm_number), 17); });
}

TEST_F(PolledLinkTest, each_request_of_several_threads_is_carried_out_once_and_each_threads_in_their_order) {
  constexpr std::uint16_t per_thread = 20;
  constexpr std::uint16_t threads_count = 6;  // more than there are slots
  with_link([&](PolledLink& link) {
    std::vector<std::thread> threads;
    for (std::uint16_t thread = 0; thread < threads_count; ++thread) {
      threads.emplace_back([&link, thread] {
        for (std::uint16_t index = 0; index < per_thread; ++index) {
          EXPECT_TRUE(link.force(flag(static_cast<std::uint16_t>(thread * 100 + index)), true).has_value());
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
  });
  EXPECT_EQ(plc.port.log.size(), std::size_t{threads_count} * per_thread);
  for (std::uint16_t thread = 0; thread < threads_count; ++thread) {
    Log own;
    Log expected;
    for (const std::string& change : plc.port.log) {
      if (std::stoi(change.substr(1)) / 100 == thread) own.push_back(change);
    }
    for (std::uint16_t index = 0; index < per_thread; ++index)
      expected.push_back(fmt::format("M{} on", thread * 100 + index));
    EXPECT_EQ(own, expected);
  }
}

TEST_F(PolledLinkTest, requests_of_several_threads_are_carried_out_in_the_order_in_which_they_were_made) {
  make_requests_last(50ms);
  options.poll_interval = 10s;
  with_link([&](PolledLink& link) {
    std::this_thread::sleep_for(60ms);  // the first poll is over
    std::vector<std::thread> threads;
    for (std::uint16_t m = 0; m < 3; ++m) {
      threads.emplace_back([&link, m] {
        (void)link.force(flag(m), true);
        if (m == 0) (void)link.force(flag(3), true);  // in the slot of the first, before that of the third
      });
      std::this_thread::sleep_for(1ms);
    }
    for (std::thread& thread : threads) thread.join();
  });
  EXPECT_EQ(plc.port.log, (Log{"M0 on", "M1 on", "M2 on", "M3 on"}));
}

TEST_F(PolledLinkTest, a_request_that_waits_longer_than_call_timeout_is_given_up_and_never_carried_out) {
  options.call_timeout = 30ms;
  make_requests_last(50ms);
  with_link([&](PolledLink& link) {
    std::thread first{[&] { (void)link.force(flag(1), true); }};
    std::this_thread::sleep_for(1ms);
    const auto begin = Clock::now();
    const auto done = link.force(flag(2), true);
    EXPECT_EQ(done.error(), FxDriverError::write_timed_out);
    EXPECT_GE(Clock::now() - begin, 30ms);
    EXPECT_LT(Clock::now() - begin, 31ms);
    first.join();
    std::this_thread::sleep_for(500ms);
  });
  EXPECT_EQ(std::ranges::count(plc.port.log, "M2 on"), 0);
}

TEST_F(PolledLinkTest, a_request_that_is_given_up_on_the_line_is_carried_out_once_and_frees_its_slot) {
  options.call_timeout = 30ms;
  make_requests_last(40ms);
  options.poll_interval = 10s;
  with_link([&](PolledLink& link) {
    std::this_thread::sleep_for(50ms);  // the first poll is over
    for (std::uint16_t m = 0; m < 2 * PolledLink::requests_max; ++m) {
      EXPECT_EQ(link.force(flag(m), true).error(), FxDriverError::write_timed_out);
      std::this_thread::sleep_for(50ms);
    }
  });
  EXPECT_EQ(plc.port.log.size(), 2 * PolledLink::requests_max);
}

TEST_F(PolledLinkTest, a_caller_that_finds_no_slot_gives_up_after_call_timeout) {
  options.call_timeout = 30ms;
  make_requests_last(1s);
  with_link([&](PolledLink& link) {
    std::vector<std::thread> threads;
    for (std::uint16_t m = 0; m < 2 * PolledLink::requests_max; ++m) {
      threads.emplace_back([&link, m] {
        const auto begin = Clock::now();
        EXPECT_EQ(link.force(flag(m), true).error(), FxDriverError::write_timed_out);
        EXPECT_LT(Clock::now() - begin, 31ms);
      });
    }
    for (std::thread& thread : threads) thread.join();
  });
}

TEST_F(PolledLinkTest, more_bytes_than_a_request_carries_are_refused) {
  with_link([](PolledLink& link) {
    std::array<std::byte, 255> bytes{};
    EXPECT_EQ(link.read_bytes(signals::m_code, bytes).error(), FxDriverError::bad_length);
    EXPECT_EQ(link.write_bytes(signals::m_code, bytes).error(), FxDriverError::bad_length);
  });
}

TEST_F(PolledLinkTest, a_failed_poll_is_the_status_until_one_succeeds) {
  with_link([&](PolledLink& link) {
    std::this_thread::sleep_for(7ms);
    plc.port.silent_from_request = 1;
    std::this_thread::sleep_for(7ms);
    EXPECT_EQ(link.status().error(), FxDriverError::no_answer);
    plc.port.silent_from_request = 0;
    std::this_thread::sleep_for(7ms);
    EXPECT_TRUE(link.status().has_value());
  });
}

TEST_F(PolledLinkTest, the_first_status_waits_for_the_first_poll_and_no_longer_than_call_timeout) {
  options.call_timeout = 30ms;
  make_requests_last(20ms);
  with_link([](PolledLink& link) { EXPECT_TRUE(link.status().has_value()); });
  make_requests_last(40ms);
  with_link([](PolledLink& link) { EXPECT_EQ(link.status().error(), FxDriverError::no_answer); });
}

TEST_F(PolledLinkTest, shutdown_answers_what_waits_and_returns_when_the_callers_have_left) {
  make_requests_last(100ms);
  std::vector<PlcLink::Done> results(2 * PolledLink::requests_max);
  in_world([&] {
    FxDriver driver{plc.port, driver_options};
    std::vector<std::thread> threads;
    {
      PolledLink link{driver, options};
      for (std::uint16_t m = 0; m < results.size(); ++m) {
        threads.emplace_back([&link, &results, m] { results[m] = link.force(flag(m), true); });
      }
      std::this_thread::sleep_for(150ms);  // the first poll is over, the first request on the line
    }
    for (std::thread& thread : threads) thread.join();
  });
  EXPECT_EQ(plc.port.log.size(), 1U);
  EXPECT_EQ(std::ranges::count_if(results, [](const PlcLink::Done& done) { return done.has_value(); }), 1);
}

TEST_F(PolledLinkTest, the_fixed_pauses_of_the_published_driver_are_kept) {
  driver_options.enq_wait = 20ms;
  driver_options.request_wait = 40ms;
  in_world([&] {
    FxDriver driver{plc.port, driver_options};
    auto begin = Clock::now();
    ASSERT_TRUE(driver.connect().has_value());
    EXPECT_GE(Clock::now() - begin, 20ms);
    EXPECT_LT(Clock::now() - begin, 21ms);
    PolledLink link{driver, {.poll_interval = 10s}};
    ASSERT_TRUE(link.status().has_value());
    begin = Clock::now();
    ASSERT_TRUE(link.force(flag(1), true).has_value());
    EXPECT_GE(Clock::now() - begin, 40ms);
    EXPECT_LT(Clock::now() - begin, 41ms);
  });
}

TEST_F(PolledLinkTest, a_program_runs_with_the_fixed_pauses_and_a_stop_of_the_axes_still_takes_effect) {
  driver_options.enq_wait = 20ms;
  driver_options.request_wait = 40ms;
  plc.set_later(300ms, 125, false);
  plc.set_later(800ms, 125, true);
  RunResult result;
  with_link([&](PolledLink& link) {
    LogicTask logic_task{link, logic};
    result = PartProgramRunner{logic_task, runner}.run(parse_program("M8 G1 X10 F600 M5\nM30").value());
  });
  EXPECT_EQ(result.outcome, RunOutcome::ended) << result.message;
  ASSERT_EQ(plc.motions().size(), 1U);
  EXPECT_GE(plc.motions()[0].length(), 1500ms - 150ms);
  EXPECT_LE(plc.motions()[0].length(), 1500ms + 150ms);
}

TEST_F(PolledLinkTest, a_status_from_before_the_strobes_ends_no_wait) {
  // FIN of the function before is still on in the last poll when the next function is given.
  options.poll_interval = 200ms;
  plc.durations[8] = 50ms;
  plc.durations[9] = 700ms;
  RunResult result;
  with_link([&](PolledLink& link) {
    LogicTask logic_task{link, logic};
    result = PartProgramRunner{logic_task, runner}.run(parse_program("M8\nM9\nM30").value());
  });
  EXPECT_EQ(result.outcome, RunOutcome::ended) << result.message;
  EXPECT_GE(plc.time_of(den_on, 1) - plc.time_of(m_strobe, 1), 700ms);
}

TEST_F(PolledLinkTest, a_status_that_grows_too_old_is_a_lost_link) {
  options.poll_interval = 1h;
  logic.status_age_max = 300ms;
  RunResult result;
  with_link([&](PolledLink& link) {
    LogicTask logic_task{link, logic};
    result = PartProgramRunner{logic_task, runner}.run(parse_program("M8\nM30").value());
  });
  ASSERT_TRUE(result.failure.has_value());
  EXPECT_EQ(result.failure->fault, LogicFault::link_lost);
}

/// The whole kernel by a polled link, its threads taking turns as chance wants.
TEST_F(PolledLinkTest, whatever_the_turns_of_the_threads_each_function_is_given_once_and_in_order) {
  const Program program = parse_program("M8 G0 X1\nM49 G0 X0\nT3 M6\nG1 X1 F6000 M9\nM30").value();
  const Log expected{"D100 = 8 0 0", "D100 = 49 0 0", "D100 = 6 0 3", "D100 = 9 0 3", "D100 = 30 0 3"};
  // The machine may be slow at any moment: no wait may end because of that.
  logic.fin_timeout = logic.ready_timeout = logic.status_age_max = 1h;
  options.call_timeout = 1h;
  std::optional<TimedPlc> fresh;
  RunResult result;
  Log functions;
  const ltsim::Outcome outcome = run_randomly(300, [&](ltsim::World& world) {
    fresh.emplace();
    fresh->durations = {{8, 20ms}, {49, 30ms}, {6, 40ms}};
    world.process("kernel").start("main", [&, &world = world] {
      FxDriver driver{fresh->port, {.retries = 0}};
      {
        PolledLink link{driver, options};
        LogicTask logic_task{link, logic};
        result = PartProgramRunner{logic_task, runner}.run(program);
      }
      functions.clear();
      for (const std::string& change : fresh->port.log) {
        if (change.starts_with("D100") && change != "D100 = 0") functions.push_back(change);
      }
      world.require(result.outcome == RunOutcome::ended, result.message);
      world.require(functions == expected, "each function once, in order");
      world.require(fresh->motions().size() == 3, "three motions");
    });
  });
  EXPECT_EQ(outcome, ltsim::Outcome{});
}

}  // namespace
}  // namespace kernel_mocks
