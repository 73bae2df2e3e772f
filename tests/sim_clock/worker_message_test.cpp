#include "sim_clock/explore/worker_message.hpp"

#include <gtest/gtest.h>

namespace ltsim {
namespace {

Failure some_failure() {
  Failure failure;
  failure.outcome = {OutcomeKind::invariant, "two\nlines, and bytes that are no text: \xff\x80"};
  failure.execution = 17;
  failure.seed = 0xfedcba9876543210U;
  failure.trace_hash = 0x8000000000000001U;
  failure.at = SimTime{1234};
  failure.schedule.scenario = "demo/some";
  failure.schedule.outcome = failure.outcome.kind;
  failure.schedule.message = one_line(failure.outcome.message);
  Deviation line;
  line.anchor = "p/one before atomic_load memory #1";
  line.to_task = "p/two";
  failure.schedule.deviations = {line};
  failure.choices_count = 5;
  failure.one_minimal = true;
  failure.story = "  story: \x80\n";
  failure.messages = {"one", "\xff"};
  return failure;
}

WorkerMessage sent_and_received(const WorkerMessage& message) {
  WorkerMessageReader reader;
  reader.add(encode(message));
  auto received = reader.next();
  EXPECT_TRUE(received);
  EXPECT_FALSE(reader.next());
  return *received;
}

TEST(WorkerMessage, a_failure_arrives_as_it_was_sent) {
  const Failure sent = some_failure();
  const auto found =
      std::get<WorkerFoundFailure>(sent_and_received(WorkerFoundFailure{.place = 3, .failure = sent}));
  EXPECT_EQ(found.place, 3U);
  const Failure& received = found.failure;
  EXPECT_EQ(received.outcome, sent.outcome);
  EXPECT_EQ(received.execution, sent.execution);
  EXPECT_EQ(received.seed, sent.seed);
  EXPECT_EQ(received.trace_hash, sent.trace_hash);
  EXPECT_EQ(received.at, sent.at);
  EXPECT_EQ(to_string(received.schedule), to_string(sent.schedule));
  EXPECT_EQ(received.schedule.deviations.front().line, 0U);
  EXPECT_TRUE(received.has_schedule);
  EXPECT_EQ(received.choices_count, sent.choices_count);
  EXPECT_EQ(received.one_minimal, sent.one_minimal);
  EXPECT_EQ(received.story, sent.story);
  EXPECT_EQ(received.messages, sent.messages);
}

TEST(WorkerMessage, the_end_of_the_work_arrives_with_its_reason) {
  const auto gave_up =
      std::get<WorkerGaveUp>(sent_and_received(WorkerGaveUp{.execution = 3, .message = "rand"}));
  EXPECT_EQ(gave_up.execution, 3U);
  EXPECT_EQ(gave_up.message, "rand");
  EXPECT_TRUE(std::holds_alternative<WorkerFinished>(sent_and_received(WorkerFinished{})));
}

TEST(WorkerMessage, messages_are_whole_whatever_the_pieces_in_which_they_arrive) {
  std::vector<std::uint8_t> bytes = encode(WorkerFoundFailure{.place = 1, .failure = some_failure()});
  const std::vector<std::uint8_t> second = encode(WorkerFinished{});
  bytes.insert(bytes.end(), second.begin(), second.end());
  WorkerMessageReader reader;
  std::size_t received_count = 0;
  for (const std::uint8_t byte : bytes) {
    reader.add(std::span{&byte, 1});
    while (reader.next()) ++received_count;
  }
  EXPECT_EQ(received_count, 2U);
}

TEST(WorkerMessage, the_part_that_a_dead_worker_leaves_behind_is_no_message) {
  std::vector<std::uint8_t> bytes = encode(WorkerFoundFailure{.place = 1, .failure = some_failure()});
  bytes.pop_back();
  WorkerMessageReader reader;
  reader.add(bytes);
  EXPECT_FALSE(reader.next());
}

}  // namespace
}  // namespace ltsim
