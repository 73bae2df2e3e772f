// The accounts of a run, made up here: what is to be accused, and what is not.

#include "tests/kill_run/accounts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "protocol/exchange_observer.hpp"
#include "protocol/shared_memory_error.hpp"
#include "tests/kill_run/payload.hpp"

namespace kill_run {
namespace {

using namespace std::chrono_literals;
using protocol::ExchangeOutcome;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

constexpr std::chrono::microseconds no_work{0};

/// A run of one kernel and one emulator, written down step by step. Time goes on by a microsecond a step.
class MadeUpRun {
 public:
  void submits(std::uint64_t number, std::uint32_t round = 0) {
    kernel(
        {.request = number, .digest = digest_of_request(number), .round = round, .event = Event::submitted});
  }
  void executes(std::uint64_t number) { executes(number, digest_of_request(number)); }
  void executes(std::uint64_t number, std::uint64_t digest) {
    emulator({.request = number, .digest = digest, .event = Event::executing});
    emulator({.request = number, .event = Event::executed});
  }
  void ends(std::uint64_t number, ExchangeOutcome outcome) {
    kernel({.request = number, .event = Event::ended, .detail = static_cast<std::uint8_t>(outcome)});
  }
  void ends_ok(std::uint64_t number) { ends_ok(number, number, digest_of_answer(number)); }
  void ends_ok(std::uint64_t number, std::uint64_t answered, std::uint64_t digest) {
    kernel({.request = number, .digest = digest, .answered = answered, .event = Event::ended});
  }
  void gives_up(std::uint64_t number) { kernel({.request = number, .event = Event::given_up}); }
  void withdraws(std::uint64_t number) { kernel({.request = number, .event = Event::withdrawn}); }
  void cannot_open(protocol::SharedMemoryError error) {
    kernel({.event = Event::open_failed, .detail = static_cast<std::uint8_t>(error)});
  }
  void is_killed(Role role) {
    const auto begin = now_;
    let_pass(1us);
    kills_.push_back({.role = role, .incarnation = 1, .begin = begin, .dead = now_});
    let_pass(1us);
  }
  void let_pass(std::chrono::nanoseconds time) { now_ += time; }

  [[nodiscard]] Accounts accounts() const {
    return account_for({.kernel = kernel_, .emulator = emulator_, .kills = kills_});
  }
  [[nodiscard]] std::vector<std::string> accusations() const { return accounts().accusations; }

  static std::uint64_t digest_of_request(std::uint64_t number) {
    return digest(protocol::fx::as_span(request(number, no_work)));
  }
  static std::uint64_t digest_of_answer(std::uint64_t number) {
    return digest(protocol::fx::as_span(answer_to(number)));
  }

 private:
  void kernel(Entry entry) { append(kernel_, entry); }
  void emulator(Entry entry) { append(emulator_, entry); }
  void append(std::vector<Entry>& journal, Entry entry) {
    entry.time = now_;
    entry.incarnation = 1;
    journal.push_back(entry);
    let_pass(1us);
  }

  Clock::time_point now_ = Clock::time_point{} + 1h;
  std::vector<Entry> kernel_;
  std::vector<Entry> emulator_;
  std::vector<Kill> kills_;
};

TEST(Accounts, of_an_ordinary_exchange_accuse_nobody) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.ends_ok(7);
  const Accounts accounts = run.accounts();
  EXPECT_THAT(accounts.accusations, IsEmpty());
  EXPECT_EQ(accounts.tally.submitted, 1U);
  EXPECT_EQ(accounts.tally.executed, 1U);
  EXPECT_THAT(accounts.tally.outcomes, ElementsAre(1, 0, 0, 0));
}

TEST(Accounts, accuse_of_the_answer_to_another_request) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.ends_ok(7, 6, MadeUpRun::digest_of_answer(6));
  EXPECT_THAT(run.accusations(), ElementsAre("I1: request 7 got the answer to request 6"));
}

TEST(Accounts, accuse_of_an_answer_to_what_was_not_executed) {
  MadeUpRun run;
  run.submits(7);
  run.ends_ok(7);
  EXPECT_THAT(run.accusations(), ElementsAre("I1: request 7 was answered and not executed"));
}

TEST(Accounts, accuse_of_a_mixed_answer) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.ends_ok(7, 7, MadeUpRun::digest_of_answer(6));
  EXPECT_THAT(run.accusations(), ElementsAre("I4: request 7 got an answer with other bytes than were given"));
}

TEST(Accounts, accuse_of_executing_mixed_bytes) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7, MadeUpRun::digest_of_request(6));
  run.ends_ok(7);
  EXPECT_THAT(run.accusations(),
              ElementsAre("I3: request 7 was executed by emulator 1 with other bytes than it has"));
}

TEST(Accounts, accuse_of_executing_what_nobody_has_submitted) {
  MadeUpRun run;
  run.executes(7);
  EXPECT_THAT(run.accusations(),
              ElementsAre("I3: request 7 was executed by emulator 1, yet nobody has submitted it"));
}

TEST(Accounts, accuse_of_executing_twice) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.executes(7);
  run.ends_ok(7);
  EXPECT_THAT(run.accusations(),
              ElementsAre("I5: request 7 was executed 2 times, first by emulator 1, last by emulator 1"));
}

class NotExecuted : public testing::TestWithParam<ExchangeOutcome> {};

TEST_P(NotExecuted, may_be_told_of_what_was_not) {
  MadeUpRun run;
  run.submits(7);
  run.ends(7, GetParam());
  EXPECT_THAT(run.accusations(), IsEmpty());
}

TEST_P(NotExecuted, must_not_be_told_of_what_was) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.ends(7, GetParam());
  EXPECT_THAT(run.accusations(), ElementsAre(StartsWith("I6: request 7 ended as ")));
}

TEST_P(NotExecuted, must_not_be_told_of_what_is_executed_later) {
  MadeUpRun run;
  run.submits(7);
  run.ends(7, GetParam());
  run.executes(7);
  EXPECT_THAT(run.accusations(), ElementsAre(StartsWith("I6: request 7 ended as ")));
}

INSTANTIATE_TEST_SUITE_P(Accounts, NotExecuted,
                         testing::Values(ExchangeOutcome::rejected, ExchangeOutcome::not_executed),
                         [](const auto& tested) {
                           return tested.param == ExchangeOutcome::rejected ? "rejected" : "not_executed";
                         });

TEST(Accounts, accuse_of_an_unknown_outcome_without_a_reason) {
  MadeUpRun run;
  run.is_killed(Role::emulator);
  run.submits(7);
  run.executes(7);
  run.ends(7, ExchangeOutcome::unknown);
  run.is_killed(Role::emulator);
  EXPECT_THAT(run.accusations(),
              ElementsAre("I18: request 7 ended as unknown, yet it was not given up and no "
                          "emulator was killed"));
}

TEST(Accounts, allow_an_unknown_outcome_when_the_emulator_was_killed_meanwhile) {
  MadeUpRun run;
  run.submits(7);
  run.is_killed(Role::emulator);
  run.ends(7, ExchangeOutcome::unknown);
  EXPECT_THAT(run.accusations(), IsEmpty());
}

TEST(Accounts, allow_an_unknown_outcome_after_a_give_up) {
  MadeUpRun run;
  run.submits(7);
  run.let_pass(usual_time_outs.take + usual_time_outs.answer);
  run.gives_up(7);
  run.ends(7, ExchangeOutcome::unknown);
  EXPECT_THAT(run.accusations(), IsEmpty());
}

TEST(Accounts, accuse_of_a_give_up_before_its_time) {
  MadeUpRun run;
  run.submits(7);
  run.let_pass(usual_time_outs.take + usual_time_outs.answer - 2us);
  run.gives_up(7);
  run.ends(7, ExchangeOutcome::unknown);
  EXPECT_THAT(run.accusations(), ElementsAre("I16: request 7 was given up after 4.999 ms"));
}

TEST(Accounts, accuse_of_a_withdrawal_before_its_time) {
  MadeUpRun run;
  run.submits(7);
  run.let_pass(usual_time_outs.take - 2us);
  run.withdraws(7);
  run.ends(7, ExchangeOutcome::not_executed);
  EXPECT_THAT(run.accusations(), ElementsAre("I16: request 7 was withdrawn after 3.999 ms"));
}

TEST(Accounts, accuse_of_a_call_beyond_its_bound) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.let_pass(call_bound(usual_time_outs) + scheduling_allowance);
  run.ends_ok(7);
  EXPECT_THAT(run.accusations(), ElementsAre(StartsWith("I15: request 7 took ")));
}

TEST(Accounts, allow_no_outcome_to_the_last_request_of_a_killed_kernel) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.is_killed(Role::kernel);
  const Accounts accounts = run.accounts();
  EXPECT_THAT(accounts.accusations, IsEmpty());
  EXPECT_EQ(accounts.tally.without_outcome, 1U);
}

TEST(Accounts, accuse_of_no_outcome_when_the_kernel_lives) {
  MadeUpRun run;
  run.submits(7);
  run.is_killed(Role::emulator);
  EXPECT_THAT(run.accusations(), ElementsAre("I18: request 7 has no outcome, yet kernel 1 was not killed"));
}

TEST(Accounts, accuse_of_no_outcome_when_the_kernel_went_on) {
  MadeUpRun run;
  run.submits(7);
  run.submits(8);
  run.is_killed(Role::kernel);
  EXPECT_THAT(run.accusations(),
              ElementsAre("I18: request 8 has no outcome, and is not the only one of kernel 1"));
}

TEST(Accounts, accuse_of_two_outcomes) {
  MadeUpRun run;
  run.submits(7);
  run.executes(7);
  run.ends_ok(7);
  run.ends_ok(7);
  EXPECT_THAT(run.accusations(), ElementsAre("I18: request 7 ended twice"));
}

TEST(Accounts, accuse_of_a_fresh_request_that_does_not_end_ok) {
  MadeUpRun run;
  run.submits(7, 1);
  run.ends(7, ExchangeOutcome::not_executed);
  EXPECT_THAT(run.accusations(),
              ElementsAre("I17: request 7 was fresh after a kill and ended as not executed"));
}

TEST(Accounts, accuse_of_a_process_that_cannot_open) {
  MadeUpRun run;
  run.cannot_open(protocol::SharedMemoryError::role_taken);
  EXPECT_THAT(run.accusations(), ElementsAre(StartsWith("I17: kernel 1 could not open: ")));
}

TEST(Payload, says_which_request_it_belongs_to_and_how_long_that_lasts) {
  const Payload asked = request(7, 250us);
  EXPECT_EQ(number_in(protocol::fx::as_span(asked)), 7U);
  EXPECT_EQ(work_in(protocol::fx::as_span(asked)), 250us);
  EXPECT_EQ(number_in(protocol::fx::as_span(answer_to(7))), 7U);
}

TEST(Payload, too_short_for_a_number_has_none) {
  const std::vector<std::byte> short_one(7, std::byte{0xFF});
  EXPECT_EQ(number_in(short_one), 0U);
  EXPECT_EQ(work_in(short_one), no_work);
}

TEST(Payload, of_two_requests_differs_in_nearly_every_place) {
  const Payload one = answer_to(1);
  const Payload other = answer_to(2);
  const std::size_t shorter = std::min(one.size(), other.size());
  std::size_t equal = 0;
  for (std::size_t i = sizeof(std::uint64_t); i < shorter; ++i) equal += one[i] == other[i] ? 1U : 0U;
  EXPECT_LT(equal, shorter / 16);
}

}  // namespace
}  // namespace kill_run
