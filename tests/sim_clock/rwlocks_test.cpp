// Locks for readers and writers: pthread_rwlock_*, std::shared_mutex.

#include <pthread.h>

#include <array>
#include <cerrno>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

class RwlocksTest : public RacesTest {
 protected:
  /// A lock that is there as long as somebody has it.
  struct Lock {
    pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
    Lock() = default;
    explicit Lock(int kind, int shared = PTHREAD_PROCESS_PRIVATE) {
      pthread_rwlockattr_t attributes;
      pthread_rwlockattr_init(&attributes);
      pthread_rwlockattr_setkind_np(&attributes, kind);
      pthread_rwlockattr_setpshared(&attributes, shared);
      pthread_rwlock_init(&lock, &attributes);
    }
    pthread_rwlock_t* operator&() { return &lock; }
  };

  static void in_a_thread(const std::function<void()>& body) { std::thread{body}.join(); }
};

TEST_F(RwlocksTest, readers_share_it_and_a_writer_has_it_alone) {
  EXPECT_EQ(run_task([](World& world) {
              Lock lock;
              world.require(pthread_rwlock_rdlock(&lock) == 0, "free");
              in_a_thread([&] {
                world.require(pthread_rwlock_tryrdlock(&lock) == 0, "another reader");
                pthread_rwlock_unlock(&lock);
                world.require(pthread_rwlock_trywrlock(&lock) == EBUSY, "no writer while one reads");
              });
              pthread_rwlock_unlock(&lock);
              world.require(pthread_rwlock_wrlock(&lock) == 0, "free again");
              in_a_thread([&] {
                world.require(pthread_rwlock_tryrdlock(&lock) == EBUSY, "no reader while one writes");
                world.require(pthread_rwlock_trywrlock(&lock) == EBUSY, "no other writer");
              });
              pthread_rwlock_unlock(&lock);
              world.require(pthread_rwlock_destroy(&lock) == 0, "free at the end");
            }),
            Outcome{});
}

TEST_F(RwlocksTest, a_reader_holds_it_until_he_has_unlocked_as_often_as_locked) {
  EXPECT_EQ(run_task([](World& world) {
              Lock lock;
              const auto can_be_written = [&] {
                bool could = false;
                in_a_thread([&] {
                  could = pthread_rwlock_trywrlock(&lock) == 0;
                  if (could) pthread_rwlock_unlock(&lock);
                });
                return could;
              };
              pthread_rwlock_rdlock(&lock);
              pthread_rwlock_rdlock(&lock);
              pthread_rwlock_unlock(&lock);
              world.require(!can_be_written(), "still held once");
              pthread_rwlock_unlock(&lock);
              world.require(can_be_written(), "free");
            }),
            Outcome{});
}

TEST_F(RwlocksTest, who_writes_is_told_of_the_deadlock_that_locking_again_would_be) {  // as with glibc
  EXPECT_EQ(run_task([](World& world) {
              Lock lock;
              pthread_rwlock_wrlock(&lock);
              world.require(pthread_rwlock_wrlock(&lock) == EDEADLK, "to write");
              world.require(pthread_rwlock_rdlock(&lock) == EDEADLK, "to read");
              const timespec deadline = in(1ms, CLOCK_REALTIME);
              world.require(pthread_rwlock_timedwrlock(&lock, &deadline) == EDEADLK, "for a while");
              world.require(pthread_rwlock_trywrlock(&lock) == EBUSY, "a try");
              world.require(pthread_rwlock_destroy(&lock) == EBUSY, "held");
              pthread_rwlock_unlock(&lock);
            }),
            Outcome{});
}

TEST_F(RwlocksTest, a_timed_lock_ends_at_its_deadline_on_the_clock_it_names) {
  EXPECT_EQ(
      run_task([](World& world) {
        Lock lock;
        std::this_thread::sleep_for(50ms);
        const auto ends_after = [&](SimTime duration, int (*call)(pthread_rwlock_t*, const timespec*),
                                    clockid_t clock) {
          const SimTime begin = world.now();
          const timespec deadline = in(duration, clock);
          in_a_thread([&] {
            world.require(call(&lock, &deadline) == ETIMEDOUT && took(world, begin, duration), "at its time");
          });
        };
        pthread_rwlock_wrlock(&lock);
        ends_after(5ms, &pthread_rwlock_timedrdlock, CLOCK_REALTIME);
        ends_after(5ms, &pthread_rwlock_timedwrlock, CLOCK_REALTIME);
        for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC}) {
          const SimTime begin = world.now();
          const timespec deadline = in(5ms, clock);
          in_a_thread([&] {
            world.require(pthread_rwlock_clockrdlock(&lock, clock, &deadline) == ETIMEDOUT, "to read");
            world.require(pthread_rwlock_clockwrlock(&lock, clock, &deadline) == ETIMEDOUT, "is over");
            world.require(took(world, begin, 5ms), "at its time");
          });
        }
        const timespec no_time{.tv_sec = 0, .tv_nsec = 1'000'000'000};
        world.require(pthread_rwlock_timedrdlock(&lock, &no_time) == EINVAL, "no time");
        world.require(pthread_rwlock_clockwrlock(&lock, CLOCK_TAI, &no_time) == EINVAL, "no clock for it");
        pthread_rwlock_unlock(&lock);
        pthread_rwlock_rdlock(&lock);
        ends_after(5ms, &pthread_rwlock_timedwrlock, CLOCK_REALTIME);
        pthread_rwlock_unlock(&lock);
        const timespec past{};
        world.require(pthread_rwlock_timedwrlock(&lock, &past) == 0, "free, and so no matter of time");
        pthread_rwlock_unlock(&lock);
      }),
      Outcome{});
}

TEST_F(RwlocksTest, a_timed_lock_takes_what_becomes_free_in_time) {
  std::shared_timed_mutex mutex;
  const Outcome outcome = run([&](World& world) {
    world.process("p").start("writer", [&] {
      mutex.lock();
      std::this_thread::sleep_for(2ms);
      mutex.unlock();
    });
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [&] {
        world.require(mutex.try_lock_shared_for(5ms) && took(world, 0ms, 2ms), "both at once");
        std::this_thread::sleep_for(1ms);
        mutex.unlock_shared();
      });
    }
    world.process("p").start("late", [&] {
      std::this_thread::sleep_for(2500us);
      world.require(mutex.try_lock_for(5ms) && took(world, 0ms, 3ms), "after the last of them");
      mutex.unlock();
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

/// A reader has it, a writer waits, and another reader comes.
Outcome another_reader_comes(int kind, bool writer_gives_up, bool* went_in_at_once,
                             Outcome (*run)(const std::function<void(World&)>&)) {
  return run([=](World& world) {
    const auto lock = std::make_shared<pthread_rwlock_t>();
    world.process("p").start("reader", [lock, kind] {
      pthread_rwlockattr_t attributes;
      pthread_rwlockattr_init(&attributes);
      pthread_rwlockattr_setkind_np(&attributes, kind);
      pthread_rwlock_init(lock.get(), &attributes);
      pthread_rwlock_rdlock(lock.get());
      std::this_thread::sleep_for(10ms);
      pthread_rwlock_unlock(lock.get());
    });
    world.process("p").start("writer", [lock, writer_gives_up] {
      std::this_thread::sleep_for(1ms);
      timespec deadline{};
      clock_gettime(CLOCK_REALTIME, &deadline);
      deadline.tv_sec += writer_gives_up ? 0 : 1;
      if (writer_gives_up) deadline.tv_nsec += 2'000'000;
      if (pthread_rwlock_timedwrlock(lock.get(), &deadline) == 0) pthread_rwlock_unlock(lock.get());
    });
    world.process("p").start("guest", [&world, lock, went_in_at_once] {
      std::this_thread::sleep_for(2ms);
      pthread_rwlock_rdlock(lock.get());
      *went_in_at_once = world.now() < 4ms;
      pthread_rwlock_unlock(lock.get());
    });
  });
}

TEST_F(RwlocksTest, a_reader_waits_behind_a_writer_only_where_that_was_asked_for) {
  for (const int kind : {PTHREAD_RWLOCK_PREFER_READER_NP, PTHREAD_RWLOCK_PREFER_WRITER_NP,
                         PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP}) {
    for (const bool writer_gives_up : {false, true}) {
      bool went_in_at_once = false;
      EXPECT_EQ(another_reader_comes(kind, writer_gives_up, &went_in_at_once, &run), Outcome{});
      const bool waits = kind == PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP && !writer_gives_up;
      EXPECT_EQ(went_in_at_once, !waits) << kind << writer_gives_up;
    }
  }
}

TEST_F(RwlocksTest, after_a_writer_readers_and_writers_come_in_any_order) {
  std::array<bool, 2> first{};
  for (int i = 0; i < 2; ++i) {
    run_randomly(100, [&](World& world) {
      struct Shared {
        std::shared_mutex mutex;
        int come = 0;
      };
      const auto shared = std::make_shared<Shared>();
      world.process("p").start("owner", [shared] {
        const std::lock_guard lock{shared->mutex};
        std::this_thread::sleep_for(1ms);
      });
      world.process("p").start("writer", [shared, &first] {
        std::this_thread::sleep_for(500us);
        const std::lock_guard lock{shared->mutex};
        first[0] = first[0] || shared->come++ == 0;
      });
      world.process("p").start("reader", [shared, &first] {
        std::this_thread::sleep_for(500us);
        const std::shared_lock lock{shared->mutex};
        first[1] = first[1] || shared->come++ == 0;
      });
    });
  }
  EXPECT_EQ(first, (std::array{true, true}));
}

TEST_F(RwlocksTest, two_readers_and_a_writer_never_see_half_a_write_and_without_the_lock_they_do) {
  for (const bool with_lock : {true, false}) {
    const Outcome outcome = run_randomly(300, [with_lock](World& world) {
      struct Shared {
        std::shared_mutex mutex;
        std::atomic<int> one = 0;
        std::atomic<int> other = 0;
      };
      const auto shared = std::make_shared<Shared>();
      for (const char* name : {"one", "two"}) {
        world.process("p").start(name, [&world, shared, with_lock] {
          std::shared_lock lock{shared->mutex, std::defer_lock};
          if (with_lock) lock.lock();
          const int one = shared->one;
          world.require(one == shared->other, "half a write was seen");
        });
      }
      world.process("p").start("writer", [shared, with_lock] {
        std::unique_lock lock{shared->mutex, std::defer_lock};
        if (with_lock) lock.lock();
        shared->one = 1;
        shared->other = 1;
      });
    });
    EXPECT_EQ(outcome, with_lock ? Outcome{} : (Outcome{OutcomeKind::invariant, "half a write was seen"}));
  }
}

// --- what is ordered ---

TEST_F(RwlocksTest, what_a_writer_does_all_know_who_lock_later_and_what_a_reader_does_only_writers) {
  pthread_rwlock_t lock = PTHREAD_RWLOCK_INITIALIZER;
  pthread_rwlock_t other = PTHREAD_RWLOCK_INITIALIZER;
  using Call = int (*)(pthread_rwlock_t*);
  const auto with = [](Call acquire, pthread_rwlock_t* which, void (*access)(int&)) -> Body {
    return [=](Memory& m) {
      acquire(which);
      access(m.value);
      pthread_rwlock_unlock(which);
    };
  };
  void (*const write_value)(int&) = [](int& value) { write(value); };
  void (*const read_value)(int&) = [](int& value) { read(value); };
  const auto kind_of = [](std::initializer_list<Body> bodies) { return run_in_turn(bodies).kind; };
  const Call reads = &pthread_rwlock_rdlock;
  const Call writes = &pthread_rwlock_wrlock;
  EXPECT_EQ(kind_of({with(writes, &lock, write_value), with(writes, &lock, write_value)}), ordered);
  EXPECT_EQ(kind_of({with(writes, &lock, write_value), with(reads, &lock, read_value)}), ordered);
  EXPECT_EQ(kind_of({with(reads, &lock, read_value), with(writes, &lock, write_value)}), ordered);
  EXPECT_EQ(kind_of({with(reads, &lock, read_value), with(reads, &lock, read_value)}), ordered);
  EXPECT_EQ(kind_of({with(reads, &lock, write_value), with(reads, &lock, write_value)}), race);
  EXPECT_EQ(kind_of({with(writes, &lock, write_value), with(writes, &other, write_value)}), race);
  EXPECT_EQ(kind_of({with(writes, &lock, write_value), with(&pthread_rwlock_tryrdlock, &lock, read_value)}),
            ordered);
  EXPECT_EQ(kind_of({with(reads, &lock, write_value), with(&pthread_rwlock_trywrlock, &lock, write_value)}),
            ordered);
}

// --- what goes wrong ---

TEST_F(RwlocksTest, an_unlock_by_who_does_not_hold_it_is_an_assertion) {
  EXPECT_EQ(run_task([](World&) {
              Lock lock;
              pthread_rwlock_rdlock(&lock);
              in_a_thread([&] { pthread_rwlock_unlock(&lock); });
            }),
            (Outcome{OutcomeKind::assertion, "rwlock-1 is released by p/thread-1, which does not hold it"}));
}

TEST_F(RwlocksTest, a_lock_that_is_never_given_back_is_a_leak) {
  const Outcome outcome = run([](World& world) {
    const auto lock = std::make_shared<Lock>();
    world.process("p").start("one", [lock] { pthread_rwlock_rdlock(&*lock); });
    world.process("p").start("two", [lock] { pthread_rwlock_rdlock(&*lock); });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::leak,
                              "rwlock-1 is still held by p/one, which has ended; "
                              "rwlock-1 is still held by p/two, which has ended"}));
}

TEST_F(RwlocksTest, who_waits_for_readers_is_told_all_of_them) {
  const Outcome outcome = run([](World& world) {
    const auto lock = std::make_shared<Lock>();
    for (const char* name : {"one", "two"})
      world.process("p").start(name, [lock] { pthread_rwlock_rdlock(&*lock); });
    world.process("p").start("writer", [lock] { pthread_rwlock_wrlock(&*lock); });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::deadlock,
                              "p/writer waits in rwlock_wrlock rwlock-1, held by p/one, which has ended "
                              "and by p/two, which has ended"}));
}

TEST_F(RwlocksTest, a_reader_who_wants_to_write_waits_for_himself) {
  EXPECT_EQ(run_task([](World&) {
              Lock lock;
              pthread_rwlock_rdlock(&lock);
              pthread_rwlock_wrlock(&lock);
            }),
            (Outcome{OutcomeKind::deadlock,
                     "a cycle of 1: p/main waits in rwlock_wrlock rwlock-1, held by p/main"}));
}

TEST_F(RwlocksTest, two_readers_who_want_to_write_are_a_cycle) {
  const Outcome outcome = run([](World& world) {
    const auto lock = std::make_shared<Lock>();
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [lock] {
        pthread_rwlock_rdlock(&*lock);
        std::this_thread::sleep_for(1ms);
        pthread_rwlock_wrlock(&*lock);
      });
    }
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::deadlock);
  EXPECT_NE(outcome.message.find("p/two waits in rwlock_wrlock rwlock-1, held by p/one and by p/two"),
            std::string::npos)
      << outcome.message;
}

TEST_F(RwlocksTest, a_reader_who_reads_again_behind_a_writer_waits_for_himself) {
  const Outcome outcome = run([](World& world) {
    const auto lock = std::make_shared<Lock>();
    world.process("p").start("reader", [lock] {
      *lock = Lock{PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP};
      pthread_rwlock_rdlock(&*lock);
      std::this_thread::sleep_for(1ms);
      pthread_rwlock_rdlock(&*lock);
    });
    world.process("p").start("writer", [lock] { pthread_rwlock_wrlock(&*lock); });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::deadlock,
                              "a cycle of 1: p/reader waits in rwlock_rdlock rwlock-1, held by p/reader; "
                              "p/writer waits in rwlock_wrlock rwlock-1, held by p/reader"}));
}

TEST_F(RwlocksTest, one_made_for_it_works_across_processes_and_another_one_wakes_nobody_there) {
  for (const int shared : {PTHREAD_PROCESS_SHARED, PTHREAD_PROCESS_PRIVATE}) {
    const Outcome outcome = run([shared](World& world) {
      world.process("a").start("main", [shared] {
        auto* const lock = static_cast<pthread_rwlock_t*>(map_segment());
        *lock = Lock{PTHREAD_RWLOCK_PREFER_READER_NP, shared}.lock;
        pthread_rwlock_wrlock(lock);
        std::this_thread::sleep_for(1ms);
        pthread_rwlock_unlock(lock);
      });
      world.process("b").start("main", [] {
        auto* const lock = static_cast<pthread_rwlock_t*>(map_segment());
        pthread_rwlock_rdlock(lock);
        pthread_rwlock_unlock(lock);
      });
    });
    EXPECT_EQ(outcome.kind, shared == PTHREAD_PROCESS_SHARED ? OutcomeKind::passed : OutcomeKind::deadlock)
        << outcome.message;
  }
}

TEST_F(RwlocksTest, one_that_a_dropped_task_held_can_be_locked_after_the_run_and_is_free_in_the_next) {
  std::shared_mutex mutex;
  bool is_first = true;
  const auto lock_and_abort = [&](World& world) {
    world.process("p").start("main", [&] {
      std::shared_mutex other;  // has the number in the second execution that the first lock had in the first
      if (!std::exchange(is_first, false)) const std::lock_guard lock{other};
      mutex.lock();
      std::abort();
    });
  };
  EXPECT_EQ(run(lock_and_abort).kind, OutcomeKind::assertion);
  {
    const std::shared_lock lock{mutex};
  }
  EXPECT_EQ(run(lock_and_abort).kind, OutcomeKind::assertion);
}

}  // namespace
}  // namespace ltsim
