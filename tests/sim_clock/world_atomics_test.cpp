// Atomic operations in a simulated task, of each width: the C++ standard's results, in private and in shared
// memory.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>

#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

template <typename Word>
class AtomicsTest : public WorldTest {
 protected:
  static constexpr Word all_bits = std::numeric_limits<Word>::max();
  static constexpr Word top_bit = static_cast<Word>(Word{1} << (std::numeric_limits<Word>::digits - 1));

  using Exercise = void (*)(World&, std::atomic_ref<Word>);

  /// Runs the exercise on a word of a segment between two others, which must stay as they are, and on one
  /// outside.
  static Outcome run_both(Exercise exercise) {
    return run([exercise](World& world) {
      world.process("p").start("main", [&world, exercise] {
        const int descriptor = shm_open("/segment", O_CREAT | O_RDWR, 0600);
        world.require(ftruncate(descriptor, 4096) == 0, "resized");
        auto* const shared =
            static_cast<Word*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
        std::array<Word, 3> own{};
        for (Word* const words : {shared, own.data()}) {
          words[0] = words[2] = 0x5a;
          exercise(world, std::atomic_ref<Word>{words[1]});
          world.require(words[0] == 0x5a && words[2] == 0x5a, "the neighbours are untouched");
        }
      });
    });
  }
};

using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(AtomicsTest, Words);

TYPED_TEST(AtomicsTest, load_store_and_exchange_carry_every_bit) {
  using Word = TypeParam;
  EXPECT_EQ(this->run_both([](World& world, std::atomic_ref<Word> word) {
    constexpr Word all = TestFixture::all_bits;
    constexpr Word top = TestFixture::top_bit;
    word.store(all);
    world.require(word.load() == all, "stored");
    word.store(5, std::memory_order_release);
    world.require(word.load(std::memory_order_acquire) == 5, "stored again");
    world.require(word.exchange(top) == 5, "exchange returns the old value");
    world.require(word.load() == top, "and stores the new one");
  }),
            Outcome{});
}

TYPED_TEST(AtomicsTest, arithmetic_returns_the_old_value_and_wraps) {
  using Word = TypeParam;
  EXPECT_EQ(this->run_both([](World& world, std::atomic_ref<Word> word) {
    constexpr Word all = TestFixture::all_bits;
    word.store(7);
    world.require(word.fetch_add(5) == 7 && word.load() == 12, "fetch_add");
    world.require(word.fetch_sub(3) == 12 && word.load() == 9, "fetch_sub");
    world.require(word.fetch_sub(10) == 9 && word.load() == all, "below zero");
    world.require(word.fetch_add(2) == all && word.load() == 1, "beyond the maximum");
  }),
            Outcome{});
}

TYPED_TEST(AtomicsTest, bit_operations_return_the_old_value) {
  using Word = TypeParam;
  EXPECT_EQ(this->run_both([](World& world, std::atomic_ref<Word> word) {
    constexpr Word top = TestFixture::top_bit;
    word.store(top | 0b1100);
    world.require(word.fetch_and(top | 0b1010) == (top | 0b1100) && word.load() == (top | 0b1000),
                  "fetch_and");
    world.require(word.fetch_or(0b0011) == (top | 0b1000) && word.load() == (top | 0b1011), "fetch_or");
    world.require(word.fetch_xor(top | 0b0110) == (top | 0b1011) && word.load() == 0b1101, "fetch_xor");
  }),
            Outcome{});
}

TYPED_TEST(AtomicsTest, compare_exchange_changes_what_is_as_expected_and_else_tells_what_is_there) {
  using Word = TypeParam;
  EXPECT_EQ(this->run_both([](World& world, std::atomic_ref<Word> word) {
    constexpr Word top = TestFixture::top_bit;
    word.store(top);
    Word expected = top;
    world.require(word.compare_exchange_strong(expected, 3), "strong, as expected");
    world.require(word.load() == 3 && expected == top, "strong: changed");
    expected = top | 3;
    world.require(!word.compare_exchange_strong(expected, 4), "strong, not as expected");
    world.require(word.load() == 3 && expected == 3, "strong: unchanged, and told");
    world.require(word.compare_exchange_weak(expected, top), "weak, as expected");
    world.require(word.load() == top && expected == 3, "weak: changed");
    expected = 0;
    world.require(!word.compare_exchange_weak(expected, 4), "weak, not as expected");
    world.require(word.load() == top && expected == top, "weak: unchanged, and told");
  }),
            Outcome{});
}

TYPED_TEST(AtomicsTest, an_atomic_object_of_the_task_obeys_too) {
  using Word = TypeParam;
  const Outcome outcome = WorldTest::run([](World& world) {
    world.process("p").start("main", [&world] {
      std::atomic<Word> word{7};
      world.require(word.exchange(8) == 7 && word.fetch_add(2) == 8 && word.fetch_sub(1) == 10, "arithmetic");
      world.require(word.fetch_or(6) == 9 && word.fetch_and(13) == 15 && word.fetch_xor(1) == 13, "bits");
      Word expected = 12;
      world.require(word.compare_exchange_strong(expected, 1) && word.load() == 1, "compare_exchange");
      world.require(!word.compare_exchange_weak(expected, 2) && expected == 1, "told");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

// Each operation is a scheduling point: between a load and a store another task can come.
TYPED_TEST(AtomicsTest, an_increment_in_two_steps_can_be_lost_and_one_in_a_single_step_cannot) {
  using Word = TypeParam;
  for (const bool single_step : {true, false}) {
    const Outcome outcome = WorldTest::run_randomly(200, [single_step](World& world) {
      struct Shared {
        std::atomic<Word> counter = 0;
        int finished = 0;
      };
      const auto shared = std::make_shared<Shared>();
      for (const char* name : {"one", "two"}) {
        world.process("p").start(name, [&world, shared, single_step] {
          if (single_step) {
            ++shared->counter;
          } else {
            shared->counter.store(static_cast<Word>(shared->counter.load() + 1));
          }
          if (++shared->finished == 2) world.require(shared->counter == 2, "an increment was lost");
        });
      }
    });
    EXPECT_EQ(outcome.passed(), single_step) << outcome.message;
  }
}

}  // namespace
}  // namespace ltsim
