#include "sim_clock/explore/seen_states.hpp"

#include <gtest/gtest.h>

namespace ltsim {
namespace {

TEST(SeenStatesTest, what_was_asleep_each_time_is_left_and_all_else_is_done) {
  SeenStates seen;
  constexpr TaskBits one = task_bit(0);
  constexpr TaskBits two = task_bit(1);
  EXPECT_EQ(seen.visit(1, one | two), 0U);
  EXPECT_EQ(seen.visit(2, 0), 0U);
  EXPECT_EQ(seen.visit(1, one), ~(one | two));  // now `two` is to be tried
  EXPECT_EQ(seen.visit(1, two), ~one);          // now `one`
  EXPECT_EQ(seen.visit(1, 0), ~TaskBits{0});
  for (std::uint64_t hash = 3; hash < 5000; ++hash) EXPECT_EQ(seen.visit(hash, 0), 0U);
  EXPECT_EQ(seen.visit(1, 0), ~TaskBits{0});
  EXPECT_EQ(seen.size(), 4999U);
}

}  // namespace
}  // namespace ltsim
