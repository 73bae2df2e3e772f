// What calls order for the race detector: semaphores, mutexes, conditions, threads.

#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

TEST_F(RaceDetectorTest, a_post_comes_before_the_wait_that_it_lets_go) {
  const auto open = [] { return sem_open("/handoff", O_CREAT, 0600, 0); };
  EXPECT_EQ(message_passing([&](Memory&) { sem_post(open()); }, [&](Memory&) { sem_wait(open()); }), ordered);
  EXPECT_EQ(message_passing([&](Memory&) { sem_post(open()); }, [&](Memory&) { sem_trywait(open()); }),
            ordered);
  EXPECT_EQ(message_passing([&](Memory&) { sem_post(open()); },
                            [&](Memory&) {
                              int count = 0;
                              sem_getvalue(open(), &count);
                            }),
            race);
}

TEST_F(RaceDetectorTest, a_wait_that_times_out_comes_after_nothing) {
  const auto open = [] { return sem_open("/handoff", O_CREAT, 0600, 0); };
  EXPECT_EQ(kind_of({[&](Memory& m) {
                       sem_post(open());
                       sem_wait(open());
                       write(m.value);
                     },
                     [&](Memory& m) {
                       const timespec deadline = in(1ms, CLOCK_REALTIME);
                       EXPECT_EQ(sem_timedwait(open(), &deadline), -1);
                       read(m.value);
                     }}),
            race);
}

TEST_F(RaceDetectorTest, a_post_that_somebody_else_has_consumed_orders_nothing) {
  const auto open = [] { return sem_open("/handoff", O_CREAT, 0600, 0); };
  EXPECT_EQ(kind_of({[&](Memory& m) {
                       write(m.value);
                       sem_post(open());
                     },
                     [&](Memory&) { sem_wait(open()); }, [&](Memory&) { sem_post(open()); },
                     [&](Memory& m) {
                       sem_wait(open());
                       read(m.value);
                     }}),
            race);
}

TEST_F(RaceDetectorTest, an_unnamed_semaphore_orders_threads) {
  sem_t semaphore;
  const auto pass = [&semaphore](Memory& memory, bool waits) {
    sem_init(&semaphore, 0, 0);
    std::thread writer{[&] {
      write(memory.value);
      sem_post(&semaphore);
    }};
    if (waits) {
      sem_wait(&semaphore);
    } else {
      std::this_thread::sleep_for(1ms);  // the writer is through by then, which proves nothing
    }
    read(memory.value);
    writer.join();
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, true); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, false); }).kind, race);
}

TEST_F(RaceDetectorTest, what_one_holder_of_a_mutex_does_the_next_one_knows) {
  std::mutex mutex;
  std::mutex other_mutex;
  const auto lock_and = [](std::mutex& with, void (*access)(int&)) -> Body {
    return [&with, access](Memory& m) {
      const std::lock_guard lock{with};
      access(m.value);
    };
  };
  void (*const write_value)(int&) = [](int& value) { write(value); };
  EXPECT_EQ(kind_of({lock_and(mutex, write_value), lock_and(mutex, write_value)}), ordered);
  EXPECT_EQ(kind_of({lock_and(mutex, write_value), lock_and(other_mutex, write_value)}), race);
}

TEST_F(RaceDetectorTest, a_condition_orders_through_its_mutex_alone) {
  const auto pass = [](Memory& memory, bool locked) {
    std::mutex mutex;
    std::condition_variable condition;
    bool ready = false;
    std::thread writer{[&] {
      {
        std::unique_lock lock{mutex};
        if (locked) write(memory.value);
        ready = true;
      }
      if (!locked) write(memory.value);
      condition.notify_one();
    }};
    {
      std::unique_lock lock{mutex};
      condition.wait(lock, [&] { return ready; });
    }
    read(memory.value);
    writer.join();
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, true); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, false); }).kind, race);
}

TEST_F(RaceDetectorTest, what_once_has_done_comes_before_who_finds_it_done) {
  static Memory* memory = nullptr;
  pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once_t another_once = PTHREAD_ONCE_INIT;
  const auto pass = [](Memory& shared, pthread_once_t& first, pthread_once_t& second) {
    memory = &shared;
    std::thread writer{[&first] { pthread_once(&first, [] { write(memory->value); }); }};
    std::this_thread::sleep_for(1ms);
    pthread_once(&second, [] {});
    read(shared.value);
    writer.join();
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, once, once); }).kind, ordered);
  once = PTHREAD_ONCE_INIT;
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, once, another_once); }).kind, race);
}

TEST_F(RaceDetectorTest, a_thread_comes_after_its_creation_and_before_its_join) {
  EXPECT_EQ(run_alone([](Memory& m) {
              write(m.value);
              std::thread{[&m] { write(m.value); }}.join();
              write(m.value);
            }).kind,
            ordered);
  EXPECT_EQ(run_alone([](Memory& m) {
              std::thread thread{[&m] { write(m.value); }};
              write(m.value);
              thread.join();
            }).kind,
            race);
  EXPECT_EQ(run_alone([](Memory& m) {
              std::thread thread{[&m] { write(m.value); }};
              std::this_thread::sleep_for(1ms);
              write(m.value);
              thread.join();
            }).kind,
            race);
}

TEST_F(RaceDetectorTest, a_futex_wake_comes_before_the_wait_that_it_ends) {
  // The notification alone: the waiter looks at the value again by a relaxed load.
  std::atomic<int> flag = 0;
  const auto pass = [&flag](Memory& memory, bool waits) {
    flag.store(0, std::memory_order_relaxed);
    std::thread writer{[&] {
      std::this_thread::sleep_for(1ms);
      write(memory.value);
      flag.store(1, std::memory_order_relaxed);
      flag.notify_one();
    }};
    if (waits) {
      flag.wait(0, std::memory_order_relaxed);
    } else {
      std::this_thread::sleep_for(2ms);
    }
    read(memory.value);
    writer.join();
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, true); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, false); }).kind, race);
}

}  // namespace
}  // namespace ltsim
