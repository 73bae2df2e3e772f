// Bounds that a scenario sets: tokens in a semaphore, loads of a word in one transaction.

#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>

#include <atomic>
#include <cstdint>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

// --- semaphores ---

class SemaphoreBoundTest : public CallsTest {
 protected:
  static Outcome post(unsigned initial, int posts, unsigned bound) {
    return run([=](World& world) {
      world.bound_semaphore("handoff", bound);
      world.process("p").start("main", [=] {
        sem_t* const other = sem_open("/other", O_CREAT, 0600, 0U);
        for (int i = 0; i < 5; ++i) sem_post(other);
        sem_t* const semaphore = sem_open("/handoff", O_CREAT, 0600, initial);
        for (int i = 0; i < posts; ++i) sem_post(semaphore);
      });
    });
  }
};

TEST_F(SemaphoreBoundTest, is_kept_up_to_the_bound) { EXPECT_EQ(post(0, 1, 1), Outcome{}); }

TEST_F(SemaphoreBoundTest, is_broken_one_past_it) {
  EXPECT_EQ(post(0, 2, 1),
            (Outcome{OutcomeKind::invariant, "semaphore handoff has count 2, at most 1 is meant (I10)"}));
}

TEST_F(SemaphoreBoundTest, is_broken_by_the_initial_count) {
  EXPECT_EQ(post(3, 0, 2).message, "semaphore handoff has count 3, at most 2 is meant (I10)");
}

TEST_F(SemaphoreBoundTest, is_not_broken_by_what_is_taken_between) {
  EXPECT_EQ(run([](World& world) {
              world.bound_semaphore("handoff", 1);
              world.process("p").start("main", [] {
                sem_t* const semaphore = sem_open("/handoff", O_CREAT, 0600, 0U);
                for (int i = 0; i < 3; ++i) {
                  sem_post(semaphore);
                  sem_wait(semaphore);
                }
              });
            }),
            Outcome{});
}

TEST_F(SemaphoreBoundTest,
       holds_for_the_semaphore_that_begins_the_segment_of_that_name_and_for_no_other_in_it) {
  const auto post_in_segment = [](std::size_t index) {
    return run([index](World& world) {
      world.bound_semaphore("bell", 1);
      world.process("p").start("main", [index] {
        const int descriptor = shm_open("/bell", O_CREAT | O_RDWR, 0600);
        static_cast<void>(ftruncate(descriptor, 4096));
        auto* const semaphores =
            static_cast<sem_t*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
        sem_init(semaphores + index, 1, 0);
        for (int i = 0; i < 2; ++i) sem_post(semaphores + index);
      });
    });
  };
  EXPECT_EQ(post_in_segment(0).message, "semaphore bell has count 2, at most 1 is meant (I10)");
  EXPECT_EQ(post_in_segment(1), Outcome{});
}

TEST_F(SemaphoreBoundTest, ends_with_the_execution) {
  EXPECT_FALSE(post(0, 2, 1).passed());
  EXPECT_EQ(run_task([](World&) {
              sem_t* const semaphore = sem_open("/handoff", O_CREAT, 0600, 0U);
              sem_post(semaphore);
              sem_post(semaphore);
            }),
            Outcome{});
}

// --- single fetch ---

class SingleFetchTest : public CallsTest {
 protected:
  static constexpr std::uint32_t offset = 8;
  using Word = std::atomic<std::uint32_t>;

  static Word& length_in(void* segment) {
    return *reinterpret_cast<Word*>(static_cast<char*>(segment) + offset);
  }

  /// p/main works on a segment, in which the word at byte 8 is to be loaded once in a transaction.
  static Outcome run_on_segment(const std::function<void(void*)>& body) {
    return run([&body](World& world) {
      world.single_fetch("segment", offset, 4, "segment.request-length");
      world.process("p").start("main", [&body] {
        void* const segment = map_segment();
        length_in(segment).store(4);
        body(segment);
      });
    });
  }
};

TEST_F(SingleFetchTest, one_load_is_allowed) {
  EXPECT_EQ(run_on_segment([](void* segment) { static_cast<void>(length_in(segment).load()); }), Outcome{});
}

TEST_F(SingleFetchTest, a_second_load_is_told_with_its_value) {
  EXPECT_EQ(run_on_segment([](void* segment) {
              if (length_in(segment).load() <= 8) static_cast<void>(length_in(segment).load());
            }),
            (Outcome{OutcomeKind::invariant,
                     "segment.request-length was loaded twice in one transaction by p/main: 4 both times"}));
}

TEST_F(SingleFetchTest, two_different_values_are_both_told) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    world.single_fetch("segment", offset, 4, "segment.request-length");
    world.process("kernel").start("main", [] {
      length_in(map_segment()).store(4);
      std::this_thread::sleep_for(1us);
      length_in(map_segment()).store(12);
    });
    world.process("emulator").start("main", [] {
      Word& length = length_in(map_segment());
      if (length.load() != 4) return;
      std::atomic<int> elsewhere = 0;
      for (int i = 0; i < 10; ++i) ++elsewhere;
      // The test is only about different values.
      std::uint32_t now = 0;
      {
        const GhostScope ghost;
        std::memcpy(&now, static_cast<const void*>(&length), sizeof now);
      }
      if (now == 12) static_cast<void>(length.load());
    });
  });
  EXPECT_EQ(outcome.message,
            "segment.request-length was loaded twice in one transaction by emulator/main: 4, then 12");
}

TEST_F(SingleFetchTest, plain_loads_and_other_mappings_count_as_well) {
  const Outcome outcome = run_on_segment([](void* segment) {
    static_cast<void>(*static_cast<volatile std::uint32_t*>(static_cast<void*>(&length_in(segment))));
    void* const again = map_segment();
    EXPECT_NE(again, segment);
    static_cast<void>(length_in(again).load());
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::invariant);
}

TEST_F(SingleFetchTest, a_longer_load_over_the_word_counts) {
  const Outcome outcome = run_on_segment([](void* segment) {
    static_cast<void>(length_in(segment).load());
    static_cast<void>(*reinterpret_cast<volatile std::uint64_t*>(static_cast<char*>(segment) + offset));
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::invariant);
}

TEST_F(SingleFetchTest, what_lies_beside_the_word_does_not_count) {
  EXPECT_EQ(run_on_segment([](void* segment) {
              for (int i = 0; i < 2; ++i) {
                static_cast<void>(*reinterpret_cast<Word*>(static_cast<char*>(segment) + offset - 4));
                static_cast<void>(reinterpret_cast<Word*>(static_cast<char*>(segment) + offset - 4)->load());
                static_cast<void>(reinterpret_cast<Word*>(static_cast<char*>(segment) + offset + 4)->load());
              }
            }),
            Outcome{});
}

TEST_F(SingleFetchTest, a_word_loaded_in_pieces_is_loaded_once) {
  EXPECT_EQ(run_on_segment([](void* segment) {
              const auto* const bytes = static_cast<volatile char*>(segment) + offset;
              for (int i = 0; i < 4; ++i) static_cast<void>(bytes[i]);
            }),
            Outcome{});
}

TEST_F(SingleFetchTest, each_task_may_load_it) {
  EXPECT_EQ(run_on_segment([](void* segment) {
              static_cast<void>(length_in(segment).load());
              std::thread{[segment] { static_cast<void>(length_in(segment).load()); }}.detach();
            }),
            Outcome{});
}

TEST_F(SingleFetchTest, a_transaction_ends_with_a_wait_a_hand_over_or_a_write_of_its_own) {
  sem_t* semaphore = nullptr;
  std::mutex mutex;
  const std::function<void(Word&)> ends[] = {
      [&](Word&) { sem_post(semaphore); },
      [&](Word&) { sem_trywait(semaphore); },
      [&](Word&) { const std::lock_guard lock{mutex}; },
      [](Word&) { std::this_thread::yield(); },
      [](Word&) { std::this_thread::sleep_for(1us); },
      [](Word& word) { word.store(5); },
      [](Word& word) { word.fetch_add(1); },
  };
  for (const auto& end : ends) {
    EXPECT_EQ(run_on_segment([&](void* segment) {
                semaphore = sem_open("/s", O_CREAT, 0600, 0U);
                for (int i = 0; i < 3; ++i) {
                  static_cast<void>(length_in(segment).load());
                  end(length_in(segment));
                }
              }),
              Outcome{});
  }
}

TEST_F(SingleFetchTest, a_write_elsewhere_or_a_look_at_the_clock_does_not_end_it) {
  const Outcome outcome = run_on_segment([](void* segment) {
    static_cast<void>(length_in(segment).load());
    static_cast<Word*>(segment)->store(1);
    static_cast<void>(std::chrono::steady_clock::now());
    static_cast<void>(length_in(segment).load());
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::invariant);
}

TEST_F(SingleFetchTest, a_word_of_more_than_eight_bytes_is_refused) {
  EXPECT_EQ(run([](World& world) { world.single_fetch("segment", 0, 9, "x"); }).kind,
            OutcomeKind::unsupported);
}

}  // namespace
}  // namespace ltsim
