#include "sim_clock/explore/random_generator.hpp"

#include <array>

#include <gtest/gtest.h>

namespace ltsim {
namespace {

// The values of the authors' C code for the state 1, 2, 3, 4, as the test of Rust's rand_xoshiro has them,
// too.
TEST(RandomGenerator, gives_the_reference_values_of_xoshiro256_plus_plus) {
  RandomGenerator generator{std::array<std::uint64_t, 4>{1, 2, 3, 4}};
  for (const std::uint64_t expected : std::initializer_list<std::uint64_t>{
           41943041U, 58720359U, 3588806011781223U, 3591011842654386U, 9228616714210784205U,
           9973669472204895162U, 14011001112246962877U, 12406186145184390807U, 15849039046786891736U,
           10450023813501588000U}) {
    EXPECT_EQ(generator.next(), expected);
  }
}

TEST(RandomGenerator, is_seeded_by_the_reference_values_of_splitmix64) {
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;
  std::uint64_t state = 1234567;
  for (const std::uint64_t expected :
       std::initializer_list<std::uint64_t>{6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                            4593380528125082431U, 16408922859458223821U}) {
    EXPECT_EQ(splitmix64(state), expected);
    state += golden;
  }
}

TEST(RandomGenerator, single_bits_are_those_of_the_words_from_the_lowest_up) {
  RandomGenerator words{7};
  RandomGenerator bits{7};
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t word = words.next();
    for (unsigned bit = 0; bit < 60; bit += 4) EXPECT_EQ(bits.bits(4), (word >> bit) & 15U);
    EXPECT_EQ(bits.bits(3), (word >> 60U) & 7U);
    EXPECT_EQ(bits.bits(1), word >> 63U);
  }
}

TEST(RandomGenerator, bounded_draws_stay_below_their_bound_and_reach_all_of_it) {
  RandomGenerator generator{1};
  for (const std::uint32_t bound : {1U, 2U, 3U, 7U, 22U}) {
    std::uint64_t seen = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::uint32_t drawn = generator.below(bound);
      ASSERT_LT(drawn, bound);
      seen |= std::uint64_t{1} << drawn;
    }
    EXPECT_EQ(seen, (std::uint64_t{1} << bound) - 1);
  }
}

// Multiplication alone would favour some of 3 x 2^30 values two to one; rejection removes that.
TEST(RandomGenerator, bounded_draws_are_unbiased_where_bias_would_be_largest) {
  constexpr std::uint32_t bound = 3U << 30U;
  constexpr int draws = 300'000;
  RandomGenerator generator{2};
  std::array<int, 3> thirds{};
  for (int i = 0; i < draws; ++i) ++thirds[generator.below(bound) % 3];
  // Standard deviation of a third: sqrt(draws * 1/3 * 2/3) = 258.
  for (const int count : thirds) EXPECT_NEAR(count, draws / 3, 5 * 258);
}

}  // namespace
}  // namespace ltsim
