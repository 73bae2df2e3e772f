#include "sim_clock/explore/coverage.hpp"

#include <gtest/gtest.h>

namespace ltsim {
namespace {

constexpr RaceDetector::LastWrite writer{.task = 1, .site = 100};
constexpr SharedAccess reader{
    .task = 2, .place = 64, .bytes = 4, .writes = false, .plain = true, .site = 200};

TEST(Coverage, counts_a_pair_once_in_an_exploration) {
  Coverage coverage;
  coverage.begin_execution();
  coverage.reads_from(writer, reader);
  coverage.reads_from(writer, reader);
  EXPECT_EQ(coverage.new_in_execution(), 1U);
  coverage.begin_execution();
  coverage.reads_from(writer, reader);
  EXPECT_EQ(coverage.new_in_execution(), 0U);
  coverage.forget();
  coverage.reads_from(writer, reader);
  EXPECT_EQ(coverage.new_in_execution(), 1U);
}

TEST(Coverage, tells_pairs_apart_by_everything_that_makes_them) {
  Coverage coverage;
  coverage.begin_execution();
  coverage.reads_from(writer, reader);
  coverage.reads_from({.task = 3, .site = 100}, reader);
  coverage.reads_from({.task = 1, .site = 101}, reader);
  coverage.reads_from({}, reader);
  for (SharedAccess other : {reader, reader, reader}) {
    static int which = 0;
    if (which == 0) other.task = 3;
    if (which == 1) other.site = 201;
    if (which == 2) other.place = 72;
    ++which;
    coverage.reads_from(writer, other);
  }
  EXPECT_EQ(coverage.new_in_execution(), 7U);
}

TEST(Coverage, counts_the_abstract_states_that_a_scenario_tells) {
  Coverage coverage;
  coverage.begin_execution();
  for (const std::uint64_t state : {0U, 1U, 2U, 1U, 0U}) coverage.abstract_state(state);
  EXPECT_EQ(coverage.new_in_execution(), 3U);
}

TEST(Coverage, a_hundred_thousand_pairs_mostly_stay_apart) {
  Coverage coverage;
  coverage.begin_execution();
  for (std::uint32_t i = 0; i < 100'000; ++i)
    coverage.reads_from(
        {.task = 1, .site = 16 * (i % 317)},
        {.task = 2, .place = 8 * (i / 317), .bytes = 8, .writes = false, .plain = true, .site = 200});
  EXPECT_GT(coverage.new_in_execution(), 90'000U);
}

}  // namespace
}  // namespace ltsim
