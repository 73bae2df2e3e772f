// Semaphores, mutexes, conditions, once and futex words in the simulated world, through the ordinary calls.

#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <semaphore>
#include <thread>

#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

class SynchronisationTest : public WorldTest {};

TEST_F(SynchronisationTest, a_named_semaphore_joins_two_processes) {
  int received = 0;
  const Outcome outcome = run_randomly(200, [&](World& world) {
    received = 0;
    world.process("a").start("main", [] {
      sem_t* const semaphore = sem_open("/s", O_CREAT, 0600, 0U);
      sem_post(semaphore);
      sem_post(semaphore);
      sem_close(semaphore);
    });
    world.process("b").start("main", [&] {
      sem_t* const semaphore = sem_open("/s", O_CREAT, 0600, 0U);
      sem_wait(semaphore);
      ++received;
      sem_wait(semaphore);
      ++received;
    });
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(received, 2);
}

TEST_F(SynchronisationTest, named_semaphores_report_what_posix_says) {
  const Outcome outcome = run([](World& world) {
    world.process("a").start("main", [&world] {
      world.require(sem_open("/none", 0) == SEM_FAILED && errno == ENOENT, "no such semaphore");
      sem_t* const semaphore = sem_open("/s", O_CREAT | O_EXCL, 0600, 3U);
      world.require(semaphore != SEM_FAILED, "created");
      world.require(sem_open("/s", O_CREAT | O_EXCL, 0600, 0U) == SEM_FAILED && errno == EEXIST, "exists");
      world.require(sem_open("/s", O_CREAT, 0600, 9U) == semaphore, "opened again, initial value ignored");
      int value = 0;
      sem_getvalue(semaphore, &value);
      world.require(value == 3, "value");
      while (sem_trywait(semaphore) == 0) {
      }
      world.require(errno == EAGAIN, "trywait on zero");
      timespec past{};
      world.require(sem_timedwait(semaphore, &past) == -1 && errno == ETIMEDOUT, "deadline in the past");
      past.tv_nsec = 1'000'000'000;
      world.require(sem_timedwait(semaphore, &past) == -1 && errno == EINVAL, "invalid nanoseconds");
      world.require(sem_unlink("/s") == 0, "unlinked");
      world.require(sem_unlink("/s") == -1 && errno == ENOENT, "unlinked once");
      world.require(sem_post(semaphore) == 0, "still usable when unlinked");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SynchronisationTest, a_timed_wait_ends_at_its_deadline) {
  SimTime ended{};
  const Outcome outcome = run([&](World& world) {
    world.process("a").start("main", [&] {
      std::counting_semaphore<> semaphore{0};
      const bool acquired = semaphore.try_acquire_for(20ms);
      ended = world.now();
      world.require(!acquired, "nobody posted");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_GE(ended, 20ms);
  EXPECT_LT(ended, 21ms);
}

TEST_F(SynchronisationTest, a_mutex_keeps_a_counter_whole_and_its_lack_is_found) {
  for (const bool with_lock : {true, false}) {
    const Outcome outcome = run_randomly(300, [with_lock](World& world) {
      struct Shared {
        std::mutex mutex;
        std::atomic<int> counter = 0;
        int finished = 0;
      };
      const auto shared = std::make_shared<Shared>();
      for (const char* name : {"one", "two"}) {
        world.process("p").start(name, [&world, shared, with_lock] {
          std::unique_lock lock{shared->mutex, std::defer_lock};
          if (with_lock) lock.lock();
          shared->counter = shared->counter + 1;
          if (with_lock) lock.unlock();
          if (++shared->finished == 2) world.require(shared->counter == 2, "an increment was lost");
        });
      }
    });
    if (with_lock) {
      EXPECT_EQ(outcome, Outcome{});
    } else {
      EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "an increment was lost"}));
    }
  }
}

TEST_F(SynchronisationTest, two_locks_taken_in_opposite_order_are_a_deadlock_that_names_who_waits) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    struct Shared {
      std::mutex a, b;
    };
    const auto shared = std::make_shared<Shared>();
    world.process("p").start("one", [shared] {
      const std::lock_guard first{shared->a};
      const std::lock_guard second{shared->b};
    });
    world.process("p").start("two", [shared] {
      const std::lock_guard first{shared->b};
      const std::lock_guard second{shared->a};
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::deadlock);
  EXPECT_TRUE(outcome.message.starts_with("a cycle of 2: p/one waits in mutex_lock mutex-"))
      << outcome.message;
  EXPECT_NE(outcome.message.find("p/two waits in mutex_lock mutex-"), std::string::npos) << outcome.message;
}

TEST_F(SynchronisationTest, a_mutex_follows_its_kind) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [&world] {
      std::recursive_mutex recursive;
      recursive.lock();
      recursive.lock();
      recursive.unlock();
      recursive.unlock();
      pthread_mutexattr_t attributes;
      pthread_mutexattr_init(&attributes);
      pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_ERRORCHECK);
      pthread_mutex_t checked;
      pthread_mutex_init(&checked, &attributes);
      world.require(pthread_mutex_unlock(&checked) == EPERM, "unlocking what is not held");
      world.require(pthread_mutex_lock(&checked) == 0, "locking");
      world.require(pthread_mutex_lock(&checked) == EDEADLK, "locking twice");
      world.require(pthread_mutex_destroy(&checked) == EBUSY, "destroying what is held");
      pthread_mutex_unlock(&checked);
      std::timed_mutex timed;
      timed.lock();
      world.require(!timed.try_lock_for(5ms) && world.now() >= 5ms, "a timed lock ends");
      timed.unlock();
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SynchronisationTest, a_mutex_unlocked_by_a_stranger_is_an_assertion) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {
      std::mutex mutex;
      mutex.unlock();
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::assertion);
}

TEST_F(SynchronisationTest, a_condition_wakes_one_or_all_and_times_out) {
  const Outcome outcome = run_randomly(300, [](World& world) {
    struct Shared {
      std::mutex mutex;
      std::condition_variable condition;
      int tokens = 0;
      int taken = 0;
    };
    const auto shared = std::make_shared<Shared>();
    for (const char* name : {"one", "two", "three"}) {
      world.process("p").start(name, [shared] {
        std::unique_lock lock{shared->mutex};
        shared->condition.wait(lock, [&] { return shared->tokens > 0; });
        --shared->tokens;
        ++shared->taken;
      });
    }
    world.process("p").start("giver", [shared, &world] {
      {
        const std::lock_guard lock{shared->mutex};
        shared->tokens = 1;
      }
      shared->condition.notify_one();
      {
        const std::lock_guard lock{shared->mutex};
        shared->tokens += 2;
      }
      shared->condition.notify_all();
      std::unique_lock lock{shared->mutex};
      const bool came = shared->condition.wait_for(lock, 10s, [] { return false; });
      world.require(!came && shared->taken == 3, "all three took a token");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SynchronisationTest, a_notification_nobody_waits_for_is_lost) {
  const Outcome outcome = run_randomly(100, [](World& world) {
    struct Shared {
      std::mutex mutex;
      std::condition_variable condition;
    };
    const auto shared = std::make_shared<Shared>();
    world.process("p").start("waiter", [shared] {
      std::unique_lock lock{shared->mutex};
      shared->condition.wait(lock);
    });
    world.process("p").start("notifier", [shared] { shared->condition.notify_one(); });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::deadlock);
  EXPECT_NE(outcome.message.find("p/waiter waits in cond_wait"), std::string::npos) << outcome.message;
}

TEST_F(SynchronisationTest, once_runs_once_and_the_others_wait_for_it) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    struct Shared {
      std::once_flag flag;
      std::atomic<int> runs = 0;
    };
    const auto shared = std::make_shared<Shared>();
    for (const char* name : {"one", "two", "three"}) {
      world.process("p").start(name, [shared, &world] {
        std::call_once(shared->flag, [&] {
          std::this_thread::sleep_for(1ms);
          ++shared->runs;
        });
        world.require(shared->runs == 1, "initialised when call_once returns");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SynchronisationTest, atomic_wait_and_notify_work_through_the_futex) {
  const Outcome outcome = run_randomly(300, [](World& world) {
    const auto word = std::make_shared<std::atomic<int>>(0);
    world.process("p").start("waiter", [word] { word->wait(0); });
    world.process("p").start("setter", [word] {
      word->store(1);
      word->notify_one();
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

/// A mutex in shared memory, initialised by the first process that comes.
struct SharedMutex {
  pthread_mutex_t mutex;
  int inside;

  static SharedMutex* map(bool shared_between_processes) {
    const int descriptor = shm_open("/m", O_CREAT | O_EXCL | O_RDWR, 0600);
    const bool first = descriptor >= 0;
    const int opened = first ? descriptor : shm_open("/m", O_RDWR, 0600);
    if (ftruncate(opened, 4096) != 0) return nullptr;
    auto* const shared =
        static_cast<SharedMutex*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0));
    if (first) {
      pthread_mutexattr_t attributes;
      pthread_mutexattr_init(&attributes);
      pthread_mutexattr_setpshared(
          &attributes, shared_between_processes ? PTHREAD_PROCESS_SHARED : PTHREAD_PROCESS_PRIVATE);
      pthread_mutex_init(&shared->mutex, &attributes);
    }
    return shared;
  }
};

Outcome two_processes_and_a_mutex(bool shared_between_processes,
                                  Outcome (*run)(unsigned, const std::function<void(World&)>&)) {
  return run(300, [shared_between_processes](World& world) {
    world.process("one").start("main", [=, &world] {
      SharedMutex* const shared = SharedMutex::map(shared_between_processes);
      sem_t* const ready = sem_open("/ready", O_CREAT, 0600, 0U);
      sem_post(ready);
      pthread_mutex_lock(&shared->mutex);
      world.require(++shared->inside == 1, "alone inside");
      std::this_thread::sleep_for(1ms);
      --shared->inside;
      pthread_mutex_unlock(&shared->mutex);
    });
    world.process("two").start("main", [=, &world] {
      sem_wait(sem_open("/ready", O_CREAT, 0600, 0U));
      SharedMutex* const shared = SharedMutex::map(shared_between_processes);
      pthread_mutex_lock(&shared->mutex);
      world.require(++shared->inside == 1, "alone inside");
      --shared->inside;
      pthread_mutex_unlock(&shared->mutex);
    });
  });
}

TEST_F(SynchronisationTest, a_mutex_made_for_it_excludes_across_processes) {
  EXPECT_EQ(two_processes_and_a_mutex(true, &run_randomly), Outcome{});
}

TEST_F(SynchronisationTest,
       a_mutex_not_made_for_it_never_wakes_the_other_process) {  // as with Linux's private futex
  const Outcome outcome = two_processes_and_a_mutex(false, &run_randomly);
  EXPECT_EQ(outcome.kind, OutcomeKind::deadlock) << outcome.message;
}

TEST_F(SynchronisationTest, a_semaphore_not_made_for_it_never_wakes_the_other_process) {
  for (const int shared : {1, 0}) {
    const Outcome outcome = run([shared](World& world) {
      world.process("a").start("main", [shared] {
        const int descriptor = shm_open("/s", O_CREAT | O_RDWR, 0600);
        ftruncate(descriptor, 4096);
        auto* const semaphore =
            static_cast<sem_t*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
        sem_init(semaphore, shared, 0);
        sem_wait(semaphore);
      });
      world.process("b").start("main", [] {
        const int descriptor = shm_open("/s", O_RDWR, 0600);
        sem_post(static_cast<sem_t*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0)));
      });
    });
    EXPECT_EQ(outcome.kind, shared == 1 ? OutcomeKind::passed : OutcomeKind::deadlock) << outcome.message;
  }
}

TEST_F(SynchronisationTest, waiting_for_a_condition_without_its_mutex_is_an_assertion) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {
      pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
      pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
      pthread_cond_wait(&condition, &mutex);
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::assertion) << outcome.message;
}

TEST_F(SynchronisationTest,
       a_recursive_mutex_locked_twice_stays_locked_while_its_owner_waits) {  // as with glibc
  for (const int locks : {1, 2}) {
    const Outcome outcome = run([locks](World& world) {
      struct Shared {
        std::recursive_mutex mutex;
        pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
      };
      const auto shared = std::make_shared<Shared>();
      world.process("p").start("waiter", [=] {
        for (int i = 0; i < locks; ++i) shared->mutex.lock();
        pthread_cond_wait(&shared->condition, shared->mutex.native_handle());
        for (int i = 0; i < locks; ++i) shared->mutex.unlock();
      });
      world.process("p").start("notifier", [=] {
        shared->mutex.lock();
        pthread_cond_signal(&shared->condition);
        shared->mutex.unlock();
      });
    });
    EXPECT_EQ(outcome.kind, locks == 1 ? OutcomeKind::passed : OutcomeKind::deadlock) << outcome.message;
  }
}

TEST_F(SynchronisationTest, call_once_passes_an_exception_on_and_lets_the_next_one_try) {
  const Outcome outcome = run_randomly(100, [](World& world) {
    struct Shared {
      std::once_flag flag;
      std::atomic<int> tries = 0;
      std::atomic<int> failures = 0;
      std::atomic<int> finished = 0;
    };
    const auto shared = std::make_shared<Shared>();
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [shared, &world] {
        try {
          std::call_once(shared->flag, [&] {
            if (++shared->tries == 1) throw 1;
          });
        } catch (int) {
          ++shared->failures;
        }
        if (++shared->finished == 2)
          world.require(shared->tries == 2 && shared->failures == 1, "one try failed");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SynchronisationTest, a_semaphore_destroyed_between_the_arrival_and_the_post_is_a_crash) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    const auto semaphore = std::make_shared<sem_t>();
    const auto ready = std::make_shared<std::atomic<bool>>(false);
    world.process("p").start("maker", [=] {
      sem_init(semaphore.get(), 0, 0);
      *ready = true;
      std::this_thread::yield();
      sem_destroy(semaphore.get());
    });
    world.process("p").start("poster", [=] {
      while (!*ready) std::this_thread::yield();
      sem_post(semaphore.get());
    });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::crash, "sem_post on memory that holds no semaphore"}));
}

}  // namespace
}  // namespace ltsim
