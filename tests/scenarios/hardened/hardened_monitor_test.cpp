// The monitor of the hardened handoff names what is broken. It is told events that the protocol never makes.

#include "tests/scenarios/hardened/hardened_monitor.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "tests/scenarios/hardened/word_ghost.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace {

using namespace std::chrono_literals;
using scenarios::HardenedMonitor;
using scenarios::HardenedWordGhost;
using Outcome = protocol::ExchangeOutcome;

std::vector<std::byte> bytes(std::string_view text) {
  const auto view = std::as_bytes(std::span(text));
  return {view.begin(), view.end()};
}

class HardenedMonitorTest : public ltsim::WorldTest {
 protected:
  /// What the monitor says of these events, if it judges by this invariant alone.
  static std::string verdict(std::string_view only, const std::function<void(HardenedMonitor&)>& events) {
    ltsim::DefaultStrategy strategy;
    return verdict_under(strategy, only, events);
  }
  static std::string verdict_under(ltsim::Strategy& strategy, std::string_view only,
                                   const std::function<void(HardenedMonitor&)>& events) {
    std::optional<HardenedMonitor> monitor;
    world().reset(strategy, nullptr);
    monitor.emplace(world(), "kernel", only, 0, protocol::hardened::Options{});
    world().process("kernel").start("main", [&] { events(*monitor); });
    world().run();
    monitor->check_at_end();
    world().end_execution();
    return world().scheduler().outcome().message;
  }
  static void ask(HardenedMonitor& monitor, std::string_view request) { monitor.submitted(bytes(request)); }
  static void serve(HardenedMonitor& monitor, std::string_view request, std::string_view answer) {
    monitor.executed(bytes(request));
    monitor.answered(bytes(answer));
  }
};

TEST_F(HardenedMonitorTest, is_silent_about_what_is_right) {
  for (const char* invariant : {"I1", "I2", "I3", "I4", "I5", "I6", "I17", "I18"}) {
    EXPECT_EQ(verdict(invariant,
                      [](HardenedMonitor& monitor) {
                        for (const char* number : {"1", "2"}) {
                          monitor.next_has_time_to_spare();
                          ask(monitor, number);
                          serve(monitor, number, std::string("to ") + number);
                          monitor.delivered(bytes(std::string("to ") + number));
                          monitor.ended(Outcome::ok);
                        }
                        ask(monitor, "3");
                        monitor.ended(Outcome::not_executed);
                      }),
              "")
        << invariant;
  }
}

TEST_F(HardenedMonitorTest, names_an_answer_to_another_request) {
  EXPECT_EQ(verdict("I1",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "1");
                      serve(monitor, "1", "a");
                      monitor.ended(Outcome::unknown);
                      ask(monitor, "2");
                      monitor.delivered(bytes("a"));
                    }),
            "I1: the answer to request 1 was delivered for request 2");
}

TEST_F(HardenedMonitorTest, names_an_answer_that_comes_twice) {
  EXPECT_EQ(verdict("I2",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "1");
                      serve(monitor, "1", "a");
                      monitor.delivered(bytes("a"));
                      monitor.delivered(bytes("a"));
                    }),
            "I2: the answer to request 1 was delivered twice");
}

TEST_F(HardenedMonitorTest, names_a_request_and_an_answer_that_nobody_gave) {
  EXPECT_EQ(verdict("I3",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "11");
                      serve(monitor, "1", "a");
                    }),
            "I3: 31 was executed, which nobody submitted");
  EXPECT_EQ(verdict("I4",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "1");
                      serve(monitor, "1", "aa");
                      monitor.delivered(bytes("a"));
                    }),
            "I4: 61 was delivered for request 1, which nobody answered so");
}

TEST_F(HardenedMonitorTest, names_a_request_that_is_executed_twice) {
  EXPECT_EQ(verdict("I5",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "1");
                      serve(monitor, "1", "a");
                      serve(monitor, "1", "a");
                    }),
            "I5: request 1 was executed twice");
}

TEST_F(HardenedMonitorTest, names_a_request_that_is_not_executed_and_yet_is_before_or_after) {
  EXPECT_EQ(verdict("I6",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "1");
                      serve(monitor, "1", "a");
                      monitor.ended(Outcome::not_executed);
                    }),
            "I6: the kernel is told that request 1 is not executed, and it was");
  EXPECT_EQ(verdict("I6",
                    [](HardenedMonitor& monitor) {
                      ask(monitor, "1");
                      monitor.ended(Outcome::not_executed);
                      serve(monitor, "1", "a");
                    }),
            "I6: the kernel was told that request 1 is not executed, and it was");
}

TEST_F(HardenedMonitorTest, names_who_uses_an_area_that_is_not_his) {
  EXPECT_EQ(verdict("I7", [](HardenedMonitor& monitor) { monitor.filling(); }),
            "I7: kernel/main writes the request, and is not its owner");
  EXPECT_EQ(verdict("I7", [](HardenedMonitor& monitor) { monitor.accepted(); }),
            "I7: kernel/main reads the response, and is not its owner");
}

TEST_F(HardenedMonitorTest, names_a_state_word_that_is_not_what_it_was_made) {
  EXPECT_EQ(verdict("I14", [](HardenedMonitor& monitor) { monitor.moved(1, 1 << 3); }).substr(0, 4), "I14:");
}

TEST_F(HardenedMonitorTest, names_a_request_that_had_time_to_spare_and_did_not_end_ok) {
  EXPECT_EQ(verdict("I17",
                    [](HardenedMonitor& monitor) {
                      monitor.set_timeouts(1s, 1s);
                      monitor.next_has_time_to_spare();
                      ask(monitor, "1");
                      monitor.ended(Outcome::not_executed);
                    }),
            "I17: request 1 had time to spare, and ended not executed");
}

TEST_F(HardenedMonitorTest, names_who_does_not_hold_his_role) {
  EXPECT_EQ(verdict("I12", [](HardenedMonitor& monitor) { monitor.filling(); }),
            "I12: kernel/main writes the request, and does not hold its role");
  EXPECT_EQ(verdict("I12",
                    [](HardenedMonitor& monitor) {
                      monitor.attached();
                      monitor.filling();
                      monitor.detaching();
                      monitor.accepted();
                    }),
            "I12: kernel/main reads the response, and does not hold its role");
}

TEST_F(HardenedMonitorTest, names_who_attaches_to_a_role_that_is_played) {
  const auto rival_attaches = [](bool after_the_first_has_detached) {
    return verdict("I28", [&](HardenedMonitor& monitor) {
      monitor.attached();
      if (after_the_first_has_detached) monitor.detaching();
      std::thread{[&] { monitor.attached(); }}.join();
    });
  };
  EXPECT_EQ(rival_attaches(false), "I28: kernel/thread-1 attaches to a role that kernel/main plays");
  EXPECT_EQ(rival_attaches(true), "");
}

TEST_F(HardenedMonitorTest, names_a_call_that_takes_longer_than_its_time_outs) {
  const auto takes = [](std::chrono::nanoseconds time) {
    return verdict("I15", [&](HardenedMonitor& monitor) {
      monitor.set_timeouts(1ms, 2ms);
      ask(monitor, "1");
      std::this_thread::sleep_for(time);
      monitor.ended(Outcome::not_executed);
    });
  };
  // Two attempts of three milliseconds each, and twenty to react.
  EXPECT_EQ(takes(25ms), "");
  EXPECT_EQ(takes(27ms).substr(0, 19), "I15: request 1 took");
}

TEST_F(HardenedMonitorTest, names_a_time_out_before_its_time) {
  using Ghost = HardenedWordGhost;
  const auto word_in = [](Ghost::Phase phase) { return 1U << 16U | 1U << 3U | phase; };
  const auto gives_up = [&](std::chrono::nanoseconds after, Ghost::Phase from, Ghost::Phase to) {
    return verdict("I16", [&](HardenedMonitor& monitor) {
      monitor.set_timeouts(1ms, 2ms);
      ask(monitor, "1");
      std::this_thread::sleep_for(after);
      monitor.moved(word_in(from), word_in(to));
    });
  };
  EXPECT_EQ(gives_up(900us, Ghost::request, Ghost::idle).substr(0, 32), "I16: request 1 was withdrawn aft");
  EXPECT_EQ(gives_up(1ms, Ghost::request, Ghost::idle), "");
  EXPECT_EQ(gives_up(2900us, Ghost::busy, Ghost::orphan).substr(0, 30), "I16: request 1 was given up af");
  EXPECT_EQ(gives_up(3ms, Ghost::busy, Ghost::orphan), "");
}

TEST_F(HardenedMonitorTest, excuses_a_request_for_all_of_whose_time_somebody_was_held_up) {
  /// Time passes for all, once.
  class Slow final : public ltsim::DefaultStrategy {
   public:
    explicit Slow(ltsim::SimTime duration) : duration_(duration) {}
    ltsim::SlowMoment slow_moment(const ltsim::SlowMomentChoice&) noexcept override {
      return {.duration = std::exchange(duration_, ltsim::SimTime{0})};
    }

   private:
    ltsim::SimTime duration_;
  };
  const auto held_up_for = [](std::chrono::nanoseconds duration) {
    Slow strategy{duration};
    return verdict_under(strategy, "I17", [](HardenedMonitor& monitor) {
      monitor.set_timeouts(1s, 1s);
      monitor.next_has_time_to_spare();
      ask(monitor, "1");
      while (std::chrono::steady_clock::now().time_since_epoch() < 500ms) {
      }
      monitor.ended(Outcome::not_executed);
    });
  };
  EXPECT_EQ(held_up_for(950ms), "");
  EXPECT_EQ(held_up_for(850ms), "I17: request 1 had time to spare, and ended not executed");
}

TEST_F(HardenedMonitorTest, names_an_end_that_is_none_or_comes_twice_or_has_no_reason) {
  const auto ends = [](std::vector<Outcome> outcomes) {
    return verdict("I18", [&](HardenedMonitor& monitor) {
      ask(monitor, "1");
      for (const Outcome outcome : outcomes) monitor.ended(outcome);
    });
  };
  EXPECT_EQ(ends({}), "I18: request 1 never ended");
  EXPECT_EQ(ends({Outcome::not_executed, Outcome::not_executed}), "I18: request 1 ended twice");
  EXPECT_EQ(ends({Outcome::ok}), "I18: request 1 ended ok without an answer");
  EXPECT_EQ(ends({Outcome::unknown}),
            "I18: request 1 ended unknown, and neither was it given up nor the slave killed");
  EXPECT_EQ(ends({Outcome::rejected}), "I18: request 1 was rejected, and nothing is wrong with it");
}

using Mover = HardenedWordGhost::Mover;

std::uint32_t word(HardenedWordGhost::Phase phase, std::uint32_t generation = 5, std::uint32_t sequence = 7) {
  return sequence << 16U | generation << 3U | phase;
}

/// How many pairs of phases may follow each other.
unsigned allowed_count(Mover mover, std::uint32_t generation_after) {
  unsigned count = 0;
  for (unsigned from = 0; from < 8; ++from) {
    for (unsigned to = 0; to < 8; ++to) {
      const auto before = word(HardenedWordGhost::Phase{from});
      HardenedWordGhost ghost{before};
      count += ghost.moves(mover, before, word(HardenedWordGhost::Phase{to}, generation_after)) ? 0U : 1U;
    }
  }
  return count;
}

TEST(HardenedWordGhost, knows_as_many_moves_as_the_table_and_no_others) {
  EXPECT_EQ(allowed_count(Mover::master, 5), 5U);
  EXPECT_EQ(allowed_count(Mover::slave, 5), 5U);
  EXPECT_EQ(allowed_count(Mover::master, 6), 6U);
  EXPECT_EQ(allowed_count(Mover::slave, 6), 8U);
  EXPECT_EQ(allowed_count(Mover::master, 7), 0U);
  EXPECT_EQ(allowed_count(Mover::slave, 4), 0U);
}

TEST(HardenedWordGhost, tells_a_move_that_undoes_another) {
  HardenedWordGhost ghost{word(HardenedWordGhost::orphan)};
  EXPECT_EQ(ghost.moves(Mover::slave, word(HardenedWordGhost::busy), word(HardenedWordGhost::response)),
            "the slave puts RESPONSE(5,7) in the place of BUSY(5,7), and undoes ORPHAN(5,7)");
}

TEST(HardenedWordGhost, lets_the_sequence_change_where_a_request_is_published_and_nowhere_else) {
  HardenedWordGhost ghost{word(HardenedWordGhost::idle)};
  EXPECT_EQ(ghost.moves(Mover::master, word(HardenedWordGhost::idle), word(HardenedWordGhost::request, 5, 8)),
            std::nullopt);
  EXPECT_EQ(
      ghost.moves(Mover::slave, word(HardenedWordGhost::request, 5, 8), word(HardenedWordGhost::busy, 5, 9)),
      "the slave puts BUSY(5,9) in the place of REQUEST(5,8): another sequence");
}

TEST(HardenedWordGhost, lets_the_generation_wrap) {
  HardenedWordGhost ghost{word(HardenedWordGhost::idle, 8191)};
  EXPECT_EQ(ghost.moves(Mover::slave, word(HardenedWordGhost::idle, 8191), word(HardenedWordGhost::idle, 0)),
            std::nullopt);
}

}  // namespace
