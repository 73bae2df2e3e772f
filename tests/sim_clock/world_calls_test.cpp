// What the calls on tasks, semaphores and shared memory promise, as POSIX and the C++ standard state it.

#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

// --- scheduling ---

TEST_F(CallsTest, a_post_wakes_the_one_that_has_waited_longest) {
  sem_t semaphore{};
  std::vector<int> woken;
  const Outcome outcome = run([&](World& world) {
    for (const int number : {3, 2, 1}) {  // the last task waits first
      world.process("p").start(std::to_string(number), [&, number] {
        std::this_thread::sleep_for(number * 1ms);
        sem_wait(&semaphore);
        woken.push_back(number);
      });
    }
    world.process("p").start("poster", [&] {
      sem_init(&semaphore, 0, 0);
      std::this_thread::sleep_for(10ms);
      for (std::size_t waiting = 3; waiting > 0; --waiting) {
        world.require(blocked_count(world, {"1", "2", "3"}) == waiting, "all others wait");
        sem_post(&semaphore);
        world.require(blocked_count(world, {"1", "2", "3"}) == waiting - 1, "one post wakes one task");
        std::this_thread::sleep_for(1ms);
      }
    });
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(woken, (std::vector<int>{1, 2, 3}));
}

TEST_F(CallsTest, a_hundred_tasks_take_turns) {
  constexpr int tasks_count = 100;
  std::vector<int> turns;
  const Outcome outcome = run([&](World& world) {
    for (int number = 0; number < tasks_count; ++number) {
      world.process("p").start(std::to_string(number), [&turns, number] {
        turns.push_back(number);
        sched_yield();
        turns.push_back(number);
      });
    }
  });
  std::vector<int> expected(2 * tasks_count);
  std::iota(expected.begin(), expected.begin() + tasks_count, 0);
  std::iota(expected.begin() + tasks_count, expected.end(), 0);
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(turns, expected);
}

TEST_F(CallsTest, a_hundred_tasks_all_run_and_wake_whatever_their_order) {
  std::atomic<int> sum = 0;
  const Outcome outcome = run_randomly(10, [&sum](World& world) {
    sum = 0;
    for (int number = 1; number <= 100; ++number) {
      world.process("p").start(std::to_string(number), [&, number] {
        std::this_thread::sleep_for(1ms);
        sum += number;
        std::this_thread::sleep_for(1h);
        world.require(sum == 5050, "everybody has added");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(sum, 5050);
}

// --- semaphores ---

TEST_F(CallsTest, an_unnamed_semaphore_begins_with_its_initial_value) {
  EXPECT_EQ(run_task([](World& world) {
              sem_t semaphore;
              world.require(sem_init(&semaphore, 0, 2) == 0, "made");
              int value = 0;
              world.require(sem_getvalue(&semaphore, &value) == 0 && value == 2, "value");
              world.require(sem_wait(&semaphore) == 0 && sem_trywait(&semaphore) == 0, "two may pass");
              world.require(sem_trywait(&semaphore) == -1 && errno == EAGAIN, "the third may not");
              world.require(sem_init(&semaphore, 0, SEM_VALUE_MAX + 1U) == -1 && errno == EINVAL, "too much");
            }),
            Outcome{});
}

TEST_F(CallsTest, a_semaphore_can_be_posted_up_to_its_maximum) {
  EXPECT_EQ(run_task([](World& world) {
              sem_t semaphore;
              world.require(sem_init(&semaphore, 0, SEM_VALUE_MAX) == 0, "made");
              world.require(sem_wait(&semaphore) == 0 && sem_post(&semaphore) == 0, "room for one");
              int value = 0;
              sem_getvalue(&semaphore, &value);
              world.require(value == SEM_VALUE_MAX, "full again");
            }),
            Outcome{});
}

TEST_F(CallsTest, a_post_beyond_the_maximum_ends_the_execution) {
  EXPECT_EQ(run_task([](World&) {
              sem_t semaphore;
              sem_init(&semaphore, 0, SEM_VALUE_MAX);
              sem_post(&semaphore);
            }),
            (Outcome{OutcomeKind::invariant,
                     "semaphore semaphore-1 is posted at its maximum, 2147483647 (EOVERFLOW)"}));
}

TEST_F(CallsTest, a_destroyed_semaphore_is_none_until_it_is_made_again) {
  EXPECT_EQ(run_task([](World& world) {
              sem_t semaphore;
              sem_init(&semaphore, 0, 1);
              world.require(sem_destroy(&semaphore) == 0, "destroyed");
              sem_init(&semaphore, 0, 1);
              world.require(sem_wait(&semaphore) == 0, "made again");
            }),
            Outcome{});
  const Outcome outcome = run_task([](World&) {
    sem_t semaphore;
    sem_init(&semaphore, 0, 1);
    sem_destroy(&semaphore);
    sem_wait(&semaphore);
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::crash);
  EXPECT_NE(outcome.message.find("sem_wait"), std::string::npos) << outcome.message;
}

// --- threads ---

TEST_F(CallsTest, a_detached_thread_can_be_neither_joined_nor_detached_again) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_t thread{};
              const auto linger = [](void*) -> void* {
                std::this_thread::sleep_for(1ms);
                return nullptr;
              };
              world.require(pthread_create(&thread, nullptr, linger, nullptr) == 0, "created");
              world.require(pthread_detach(thread) == 0, "detached");
              world.require(pthread_join(thread, nullptr) == EINVAL, "not joined");
              world.require(pthread_detach(thread) == EINVAL, "not again");
              world.require(world.now() < 1ms, "while it still runs");
            }),
            Outcome{});
}

std::vector<int> destroyed;

struct Traced {
  int number;
  ~Traced() { destroyed.push_back(number); }
};

TEST_F(CallsTest, thread_local_objects_are_destroyed_in_the_reverse_order_of_their_construction) {
  destroyed.clear();
  EXPECT_EQ(run_task([](World& world) {
              std::thread{[&] {
                thread_local const Traced first{1};
                thread_local const Traced second{2};
                thread_local const Traced third{3};
                world.require(first.number + second.number + third.number == 6, "constructed");
              }}.join();
            }),
            Outcome{});
  EXPECT_EQ(destroyed, (std::vector<int>{3, 2, 1}));
}

TEST_F(CallsTest, a_process_has_one_number_and_no_other_has_it) {
  std::array<pid_t, 4> numbers{};
  const Outcome outcome = run([&](World& world) {
    for (const std::size_t i : {0U, 1U, 2U, 3U})
      world.process(i < 2 ? "a" : "b").start(std::to_string(i), [&, i] { numbers[i] = getpid(); });
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(numbers[0], numbers[1]);
  EXPECT_EQ(numbers[2], numbers[3]);
  EXPECT_NE(numbers[0], numbers[2]);
}

// --- shared memory ---

TEST_F(CallsTest, a_volatile_store_to_a_segment_can_come_too_late) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    world.allow_data_races();
    const auto finished = std::make_shared<int>(0);
    for (const char* name : {"a", "b"}) {
      world.process(name).start("main", [&world, finished] {
        auto* const counter = static_cast<volatile int*>(map_segment());
        *counter = *counter + 1;
        if (++*finished == 2) world.require(*counter == 2, "an increment was lost");
      });
    }
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "an increment was lost"}));
}

TEST_F(CallsTest, two_volatile_loads_from_a_segment_can_differ) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    world.allow_data_races();
    world.process("a").start("main", [] { *static_cast<volatile int*>(map_segment()) = 1; });
    world.process("b").start("main", [&world] {
      const auto* const value = static_cast<const volatile int*>(map_segment());
      const int first = *value;
      world.require(first == *value, "it changed between the loads");
    });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "it changed between the loads"}));
}

__extension__ using SixteenBytes = unsigned __int128;

// The writer is over in one step, so what is torn is the reader's copy.
TEST_F(CallsTest, a_copy_out_of_a_segment_can_be_torn) {
  const Outcome outcome = run_randomly(300, [](World& world) {
    world.allow_data_races();
    world.process("a").start("main",
                             [] { *static_cast<volatile SixteenBytes*>(map_segment()) = ~SixteenBytes{0}; });
    world.process("b").start("main", [&world] {
      const void* const bytes = map_segment();
      std::array<std::uint64_t, 2> seen{};
      std::memcpy(seen.data(), bytes, sizeof seen);
      world.require(seen[0] == seen[1], "half old, half new");
    });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "half old, half new"}));
}

}  // namespace
}  // namespace ltsim
