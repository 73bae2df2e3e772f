// What the calls on clocks, deadlines and sleeping promise, as POSIX and the C++ standard state it.

#include <pthread.h>
#include <semaphore.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <condition_variable>
#include <ctime>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

// --- clocks ---

TEST_F(CallsTest, deadlines_of_a_semaphore_are_read_on_their_clock) {
  EXPECT_EQ(run_task([](World& world) {
              sem_t semaphore;
              sem_init(&semaphore, 0, 0);
              std::this_thread::sleep_for(50ms);
              SimTime begin = world.now();
              timespec deadline = in(20ms, CLOCK_REALTIME);
              world.require(sem_timedwait(&semaphore, &deadline) == -1 && errno == ETIMEDOUT, "nobody posts");
              world.require(took(world, begin, 20ms), "sem_timedwait");
              for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
                begin = world.now();
                deadline = in(20ms, clock);
                world.require(sem_clockwait(&semaphore, clock, &deadline) == -1 && errno == ETIMEDOUT,
                              "nor now");
                world.require(took(world, begin, 20ms), "sem_clockwait");
              }
            }),
            Outcome{});
}

TEST_F(CallsTest, deadlines_of_a_mutex_are_read_on_their_clock) {
  EXPECT_EQ(run_task([](World& world) {
              std::timed_mutex mutex;
              mutex.lock();
              std::thread{[&] {
                std::this_thread::sleep_for(50ms);
                SimTime begin = world.now();
                world.require(!mutex.try_lock_until(std::chrono::system_clock::now() + 20ms), "held");
                world.require(took(world, begin, 20ms), "system clock");
                begin = world.now();
                world.require(!mutex.try_lock_until(std::chrono::steady_clock::now() + 20ms), "still held");
                world.require(took(world, begin, 20ms), "steady clock");
              }}.join();
              mutex.unlock();
            }),
            Outcome{});
}

TEST_F(CallsTest, deadlines_of_a_condition_are_read_on_their_clock) {
  EXPECT_EQ(run_task([](World& world) {
              std::mutex mutex;
              std::condition_variable condition;
              std::unique_lock lock{mutex};
              std::this_thread::sleep_for(50ms);
              SimTime begin = world.now();
              world.require(condition.wait_until(lock, std::chrono::system_clock::now() + 20ms) ==
                                std::cv_status::timeout,
                            "nobody signals");
              world.require(took(world, begin, 20ms), "system clock");
              begin = world.now();
              world.require(condition.wait_until(lock, std::chrono::steady_clock::now() + 20ms) ==
                                std::cv_status::timeout,
                            "nor now");
              world.require(took(world, begin, 20ms), "steady clock");
            }),
            Outcome{});
}

TEST_F(CallsTest, a_condition_keeps_the_clock_of_its_attributes) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
              std::this_thread::sleep_for(50ms);
              for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
                pthread_condattr_t attributes;
                pthread_condattr_init(&attributes);
                pthread_condattr_setclock(&attributes, clock);
                pthread_cond_t condition;
                pthread_cond_init(&condition, &attributes);
                pthread_mutex_lock(&mutex);
                const SimTime begin = world.now();
                const timespec deadline = in(20ms, clock);
                world.require(pthread_cond_timedwait(&condition, &mutex, &deadline) == ETIMEDOUT,
                              "no signal");
                world.require(took(world, begin, 20ms), "on its clock");
                pthread_mutex_unlock(&mutex);
              }
            }),
            Outcome{});
}

TEST_F(CallsTest, a_deadline_at_the_end_of_time_never_comes) {
  const Outcome outcome = run_randomly(50, [](World& world) {
    struct Shared {
      std::mutex mutex;
      std::condition_variable condition;
      bool acted = false;
    };
    const auto shared = std::make_shared<Shared>();
    world.process("p").start("semaphore", [shared, &world] {
      const timespec never{.tv_sec = std::numeric_limits<time_t>::max(), .tv_nsec = 0};
      sem_t* const semaphore = sem_open("/s", O_CREAT, 0600, 0U);
      world.require(sem_timedwait(semaphore, &never) == 0 && shared->acted, "posted");
    });
    world.process("p").start("condition", [shared, &world] {
      std::unique_lock lock{shared->mutex};
      if (!shared->acted) shared->condition.wait_until(lock, std::chrono::system_clock::time_point::max());
      world.require(shared->acted, "signalled");
    });
    world.process("p").start("actor", [shared] {
      for (int i = 0; i < 5; ++i) std::this_thread::sleep_for(24h);
      const std::lock_guard lock{shared->mutex};
      shared->acted = true;
      shared->condition.notify_one();
      sem_post(sem_open("/s", O_CREAT, 0600, 0U));
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(CallsTest, sleeping_takes_as_long_as_it_says) {
  EXPECT_EQ(run_task([](World& world) {
              world.require(usleep(1500) == 0 && took(world, 0ms, 1500us), "usleep");
              SimTime begin = world.now();
              world.require(sleep(2) == 0 && took(world, begin, 2s), "sleep");
              const timespec duration{.tv_sec = 1, .tv_nsec = 500};
              begin = world.now();
              world.require(nanosleep(&duration, nullptr) == 0 && took(world, begin, 1s + 500ns),
                            "nanosleep");
              for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) {
                begin = world.now();
                world.require(clock_nanosleep(clock, 0, &duration, nullptr) == 0, "relative");
                world.require(took(world, begin, 1s + 500ns), "relative, its length");
                begin = world.now();
                const timespec deadline = in(1s, clock);
                world.require(clock_nanosleep(clock, TIMER_ABSTIME, &deadline, nullptr) == 0, "absolute");
                world.require(took(world, begin, 1s), "absolute, its length");
                begin = world.now();
                world.require(clock_nanosleep(clock, TIMER_ABSTIME, &deadline, nullptr) == 0, "in the past");
                world.require(took(world, begin, 0s), "a deadline in the past is due at once");
              }
              begin = world.now();
              std::this_thread::sleep_until(std::chrono::steady_clock::now() + 7ms);
              world.require(took(world, begin, 7ms), "sleep_until, steady clock");
              begin = world.now();
              std::this_thread::sleep_until(std::chrono::system_clock::now() + 7ms);
              world.require(took(world, begin, 7ms), "sleep_until, system clock");
            }),
            Outcome{});
}

TEST_F(CallsTest, a_sleep_of_a_thousand_million_nanoseconds_or_of_less_than_none_is_refused) {
  EXPECT_EQ(run_task([](World& world) {
              for (const long nanoseconds : {1'000'000'000L, -1L}) {
                const timespec duration{.tv_sec = 0, .tv_nsec = nanoseconds};
                world.require(nanosleep(&duration, nullptr) == -1 && errno == EINVAL, "nanosleep");
                world.require(clock_nanosleep(CLOCK_MONOTONIC, 0, &duration, nullptr) == EINVAL,
                              "clock_nanosleep returns the error number");
              }
              const timespec longest_fraction{.tv_sec = 0, .tv_nsec = 999'999'999};
              world.require(nanosleep(&longest_fraction, nullptr) == 0, "one less is a duration");
            }),
            Outcome{});
}

TEST_F(CallsTest, the_time_of_day_counts_microseconds) {
  EXPECT_EQ(run_task([](World& world) {
              usleep(2'001'500);
              timeval now{};
              world.require(gettimeofday(&now, nullptr) == 0, "read");
              world.require(now.tv_sec == 1'767'225'602, "two seconds after 2026-01-01T00:00:00Z");
              world.require(now.tv_usec >= 1500 && now.tv_usec < 1520, "and 1500 microseconds");
            }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
