// What the calls on mutexes, conditions and futex words promise, as POSIX, Linux and the C++ standard state it.

#include <linux/futex.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <limits>
#include <memory>
#include <mutex>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

// --- mutexes and conditions ---

TEST_F(CallsTest, a_recursive_mutex_is_held_until_it_is_unlocked_as_often_as_locked) {
  EXPECT_EQ(run_task([](World& world) {
              std::recursive_mutex mutex;
              mutex.lock();
              world.require(mutex.try_lock(), "its owner may try");
              mutex.unlock();
              world.require(!another_could_lock(mutex), "still held once");
              mutex.lock();
              mutex.unlock();
              world.require(!another_could_lock(mutex), "and still");
              mutex.unlock();
              world.require(another_could_lock(mutex), "free");
            }),
            Outcome{});
}

TEST_F(CallsTest, a_plain_mutex_cannot_be_tried_twice_by_its_owner) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
              world.require(pthread_mutex_trylock(&mutex) == 0, "free");
              world.require(pthread_mutex_trylock(&mutex) == EBUSY, "held");
              pthread_mutex_unlock(&mutex);
            }),
            Outcome{});
}

TEST_F(CallsTest, a_recursive_mutex_is_held_as_often_after_waiting_for_a_condition_as_before) {
  for (const int locked_count : {1, 2}) {
    EXPECT_EQ(run_task([locked_count](World& world) {
                std::recursive_mutex mutex;
                pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
                for (int i = 0; i < locked_count; ++i) mutex.lock();
                // The count of another must not be taken for the waiter's own. Only one locked once is free
                // meanwhile: how far a wait unlocks one locked twice, POSIX leaves open.
                std::thread other{[&] {
                  if (locked_count > 1) return;
                  const std::lock_guard lock{mutex};
                }};
                const timespec deadline = in(1ms, CLOCK_REALTIME);
                world.require(
                    pthread_cond_timedwait(&condition, mutex.native_handle(), &deadline) == ETIMEDOUT,
                    "nobody signals");
                other.join();
                for (int i = 0; i < locked_count; ++i) {
                  world.require(!another_could_lock(mutex), "still held");
                  mutex.unlock();
                }
                world.require(another_could_lock(mutex), "free");
              }),
              Outcome{})
        << locked_count;
  }
}

TEST_F(CallsTest, a_signal_wakes_one_of_two_and_a_broadcast_both) {
  std::mutex mutex;
  std::condition_variable condition;
  int woken = 0;
  const Outcome outcome = run([&](World& world) {
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [&] {
        for (int i = 0; i < 2; ++i) {
          std::unique_lock lock{mutex};
          condition.wait(lock);
          ++woken;
        }
      });
    }
    world.process("p").start("notifier", [&] {
      std::this_thread::sleep_for(1ms);
      for (const int expected : {1, 2}) {
        condition.notify_one();
        world.require(blocked_count(world, {"one", "two"}) == 1, "one was woken");
        std::this_thread::sleep_for(1ms);
        world.require(woken == expected, "and went on");
      }
      condition.notify_all();
      world.require(blocked_count(world, {"one", "two"}) == 0, "both were woken");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(woken, 4);
}

TEST_F(CallsTest, an_unlock_wakes_one_of_those_that_wait) {
  std::mutex mutex;
  int locked = 0;
  const Outcome outcome = run([&](World& world) {
    world.process("p").start("owner", [&] {
      const std::unique_lock lock{mutex};
      std::this_thread::sleep_for(1ms);
      world.require(blocked_count(world, {"one", "two"}) == 2, "both wait");
      mutex.unlock();
      world.require(blocked_count(world, {"one", "two"}) == 1, "one was woken");
      mutex.lock();
    });
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [&] {
        const std::lock_guard lock{mutex};
        ++locked;
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(locked, 2);
}

TEST_F(CallsTest, a_timed_lock_takes_a_mutex_that_is_free_or_becomes_so) {
  std::timed_mutex mutex;
  const Outcome outcome = run([&](World& world) {
    world.process("p").start("one", [&] {
      world.require(mutex.try_lock_for(5ms) && took(world, 0ms, 0ms), "free");
      std::this_thread::sleep_for(2ms);
      mutex.unlock();
    });
    world.process("p").start("two", [&] {
      world.require(mutex.try_lock_for(5ms) && took(world, 0ms, 2ms), "freed in time");
      mutex.unlock();
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

// --- futex words ---

TEST_F(CallsTest, waiting_for_an_atomic_blocks_and_notify_one_wakes_one_of_two) {
  std::atomic<int> word = 0;
  int woken = 0;
  const Outcome outcome = run([&](World& world) {
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [&] {
        word.wait(0);
        ++woken;
      });
    }
    world.process("p").start("setter", [&] {
      std::this_thread::sleep_for(1ms);  // libstdc++ spins before it calls the system
      world.require(blocked_count(world, {"one", "two"}) == 2, "both wait");
      word.store(1);
      std::this_thread::sleep_for(1ms);
      world.require(woken == 0, "a store alone wakes nobody");
      for (const int expected : {1, 2}) {
        word.notify_one();
        std::this_thread::sleep_for(1ms);
        world.require(woken == expected, "one was woken");
      }
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(CallsTest, notify_all_wakes_all_that_wait_for_an_atomic) {
  std::atomic<int> word = 0;
  const Outcome outcome = run([&](World& world) {
    for (const char* name : {"one", "two", "three"}) world.process("p").start(name, [&] { word.wait(0); });
    world.process("p").start("setter", [&] {
      std::this_thread::sleep_for(1ms);
      word.store(1);
      word.notify_all();
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(CallsTest, a_futex_wait_for_a_value_that_has_changed_returns_at_once) {
  EXPECT_EQ(
      run_task([](World& world) {
        std::uint32_t word = 0;
        const timespec millisecond{.tv_sec = 0, .tv_nsec = 1'000'000};
        std::this_thread::sleep_for(3ms);
        SimTime begin = world.now();
        world.require(syscall(SYS_futex, &word, FUTEX_WAIT, 1, nullptr) == -1 && errno == EAGAIN, "changed");
        world.require(took(world, begin, 0ms), "at once");
        begin = world.now();
        world.require(syscall(SYS_futex, &word, FUTEX_WAIT, 0, &millisecond) == -1 && errno == ETIMEDOUT,
                      "nobody wakes");
        world.require(took(world, begin, 1ms), "the time-out is relative");
        world.require(syscall(SYS_futex, &word, FUTEX_WAKE, 1) == 0, "nobody waits");
      }),
      Outcome{});
}

TEST_F(CallsTest, a_futex_wait_with_a_bit_set_has_a_deadline_on_the_clock_it_names) {  // futex(2)
  EXPECT_EQ(
      run_task([](World& world) {
        std::uint32_t word = 0;
        std::this_thread::sleep_for(50ms);
        for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
          const int operation = FUTEX_WAIT_BITSET | (clock == CLOCK_REALTIME ? FUTEX_CLOCK_REALTIME : 0);
          const SimTime begin = world.now();
          const timespec deadline = in(20ms, clock);
          world.require(
              syscall(SYS_futex, &word, operation, 0, &deadline, nullptr, FUTEX_BITSET_MATCH_ANY) == -1 &&
                  errno == ETIMEDOUT,
              "nobody wakes");
          world.require(took(world, begin, 20ms), "at the deadline");
        }
      }),
      Outcome{});
}

TEST_F(CallsTest, a_counting_semaphore_is_tried_for_the_time_given) {
  EXPECT_EQ(run_task([](World& world) {
              std::counting_semaphore<> semaphore{1};
              std::this_thread::sleep_for(50ms);
              const SimTime begin = world.now();
              world.require(semaphore.try_acquire_for(20ms) && took(world, begin, 0ms), "free");
              world.require(!semaphore.try_acquire_for(20ms) && took(world, begin, 20ms), "nobody releases");
              std::thread releaser{[&] {
                std::this_thread::sleep_for(5ms);
                semaphore.release();
              }};
              world.require(semaphore.try_acquire_for(20ms), "released");
              world.require(world.now() - begin < 26ms, "in time");
              releaser.join();
            }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
