#include "sim_clock/explore/forked_work.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "sim_clock/explore/schedule.hpp"

namespace ltsim {
namespace {

struct Refused {
  std::string message;
};

TEST(ForkedWork, changes_nothing_but_what_it_hands_over_and_what_is_shared) {
  ForkedWork forks;
  const SharedMemory shared{1};
  int variable = 1;
  const int handed_over = forks.run<int, Refused>([&] {
    setenv("OF_FORKED_WORK", "yes", 1);
    shared.bytes()[0] = std::byte{3};
    return ++variable;
  });
  EXPECT_EQ(handed_over, 2);
  EXPECT_EQ(variable, 1);
  EXPECT_EQ(getenv("OF_FORKED_WORK"), nullptr);
  EXPECT_EQ(shared.bytes()[0], std::byte{3});
  EXPECT_EQ(ForkedWork::process(), 0);
}

TEST(ForkedWork, hands_over_texts_rows_and_what_is_made_of_them) {
  Schedule schedule;
  schedule.scenario = "demo/handed-over";
  schedule.message = std::string(100'000, 'x');
  schedule.input = {"", "two"};
  schedule.deviations.resize(3);
  schedule.deviations[1].anchor = "kernel/main end";
  schedule.deviations[1].answer = 7;
  ForkedWork forks;
  using Row = std::vector<std::optional<std::pair<std::string, std::uint64_t>>>;
  const auto [back, row] = forks.run<std::pair<Schedule, Row>, Refused>(
      [&] { return std::pair{schedule, Row{std::nullopt, std::pair{"text", 5}}}; });
  EXPECT_EQ(to_string(back), to_string(schedule));
  EXPECT_EQ(back.deviations, schedule.deviations);
  EXPECT_EQ(row, (Row{std::nullopt, std::pair{"text", 5}}));
}

TEST(ForkedWork, throws_here_what_it_has_thrown_there) {
  ForkedWork forks;
  try {
    forks.run<int, Refused>([]() -> int { throw Refused{"cannot be"}; });
    FAIL();
  } catch (const Refused& refused) {
    EXPECT_EQ(refused.message, "cannot be");
  }
  try {
    forks.run<int, Refused>([]() -> int { throw std::logic_error{"is wrong"}; });
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "is wrong");
  }
}

TEST(ForkedWorkDeathTest, takes_the_process_with_it_in_the_way_it_dies) {
  EXPECT_EXIT(static_cast<void>(ForkedWork{}.run<int, Refused>([]() -> int { _exit(5); })),
              testing::ExitedWithCode(5), "");
  EXPECT_EXIT(static_cast<void>(ForkedWork{}.run<int, Refused>([]() -> int { std::abort(); })),
              testing::KilledBySignal(SIGABRT), "");
}

}  // namespace
}  // namespace ltsim
