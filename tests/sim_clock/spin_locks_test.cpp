// Spin locks: pthread_spin_*.

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <cerrno>
#include <memory>
#include <thread>

#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

class SpinLocksTest : public RacesTest {
 protected:
  struct Lock {
    pthread_spinlock_t lock;
    Lock() { pthread_spin_init(&lock, PTHREAD_PROCESS_PRIVATE); }
    pthread_spinlock_t* operator&() { return &lock; }
  };
};

TEST_F(SpinLocksTest, one_has_it_and_others_can_try) {
  EXPECT_EQ(run_task([](World& world) {
              Lock lock;
              world.require(pthread_spin_lock(&lock) == 0, "free");
              world.require(pthread_spin_trylock(&lock) == EBUSY, "held");
              world.require(pthread_spin_destroy(&lock) == EBUSY, "held, to the destroyer");
              std::thread other{[&] {
                world.require(pthread_spin_lock(&lock) == 0 && world.now() >= 1ms, "when it is free");
                pthread_spin_unlock(&lock);
              }};
              std::this_thread::sleep_for(1ms);
              world.require(pthread_spin_unlock(&lock) == 0, "given back");
              other.join();
              world.require(pthread_spin_trylock(&lock) == 0, "free again");
              pthread_spin_unlock(&lock);
              world.require(pthread_spin_destroy(&lock) == 0, "free to the destroyer");
            }),
            Outcome{});
}

TEST_F(SpinLocksTest, it_keeps_a_counter_whole_and_its_lack_is_found) {
  for (const bool with_lock : {true, false}) {
    const Outcome outcome = run_randomly(300, [with_lock](World& world) {
      struct Shared {
        pthread_spinlock_t lock;
        std::atomic<int> counter = 0;
        int finished = 0;
      };
      const auto shared = std::make_shared<Shared>();
      pthread_spin_init(&shared->lock, PTHREAD_PROCESS_PRIVATE);
      for (const char* name : {"one", "two"}) {
        world.process("p").start(name, [&world, shared, with_lock] {
          if (with_lock) pthread_spin_lock(&shared->lock);
          shared->counter = shared->counter + 1;
          if (with_lock) pthread_spin_unlock(&shared->lock);
          if (++shared->finished == 2) world.require(shared->counter == 2, "an increment was lost");
        });
      }
    });
    EXPECT_EQ(outcome, with_lock ? Outcome{} : (Outcome{OutcomeKind::invariant, "an increment was lost"}));
  }
}

TEST_F(SpinLocksTest, what_one_holder_does_the_next_one_knows) {
  pthread_spinlock_t lock;
  pthread_spinlock_t other;
  pthread_spin_init(&lock, PTHREAD_PROCESS_PRIVATE);
  pthread_spin_init(&other, PTHREAD_PROCESS_PRIVATE);
  const auto with = [](pthread_spinlock_t* which, int (*acquire)(pthread_spinlock_t*)) -> Body {
    return [=](Memory& m) {
      acquire(which);
      write(m.value);
      pthread_spin_unlock(which);
    };
  };
  EXPECT_EQ(run_in_turn({with(&lock, &pthread_spin_lock), with(&lock, &pthread_spin_lock)}).kind, ordered);
  EXPECT_EQ(run_in_turn({with(&lock, &pthread_spin_lock), with(&lock, &pthread_spin_trylock)}).kind, ordered);
  EXPECT_EQ(run_in_turn({with(&lock, &pthread_spin_lock), with(&other, &pthread_spin_lock)}).kind, race);
}

TEST_F(SpinLocksTest, what_goes_wrong_with_it_is_told) {
  EXPECT_EQ(run_task([](World&) {
              Lock lock;
              pthread_spin_lock(&lock);
              pthread_spin_lock(&lock);
            }),
            (Outcome{OutcomeKind::deadlock,
                     "a cycle of 1: p/main waits in spin_lock spin-lock-1, held by p/main"}));
  EXPECT_EQ(run_task([](World&) {
              Lock lock;
              pthread_spin_unlock(&lock);
            }),
            (Outcome{OutcomeKind::assertion, "spin-lock-1 is released by p/main, which does not hold it"}));
  EXPECT_EQ(run_task([](World&) {
              Lock lock;
              pthread_spin_lock(&lock);
            }),
            (Outcome{OutcomeKind::leak, "spin-lock-1 is still held by p/main, which has ended"}));
  EXPECT_EQ(run_task([](World&) {
              pthread_spinlock_t never_made = 0;
              pthread_spin_lock(&never_made);
            }),
            (Outcome{OutcomeKind::crash, "spin_lock on memory that holds no spin lock"}));
}

TEST_F(SpinLocksTest, one_that_a_dropped_task_held_is_free_in_the_next_execution) {
  pthread_spinlock_t lock;
  pthread_spin_init(&lock, PTHREAD_PROCESS_PRIVATE);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run([&](World& world) {
                world.process("p").start("main", [&] {
                  pthread_spin_lock(&lock);
                  std::abort();
                });
              }).kind,
              OutcomeKind::assertion);
  }
}

TEST_F(SpinLocksTest, one_in_a_segment_works_across_processes) {
  EXPECT_EQ(run([](World& world) {
              for (const char* name : {"a", "b"}) {
                world.process(name).start("main", [&world, name] {
                  auto* const lock = static_cast<pthread_spinlock_t*>(map_segment());
                  if (*name == 'a') pthread_spin_init(lock, PTHREAD_PROCESS_SHARED);
                  pthread_spin_lock(lock);
                  std::this_thread::sleep_for(1ms);
                  pthread_spin_unlock(lock);
                  world.require(*name == 'a' || world.now() >= 2ms, "one after the other");
                });
              }
            }),
            Outcome{});
}

TEST_F(SpinLocksTest, on_one_processor_who_spins_keeps_it_from_an_owner_of_lower_priority) {
  const auto run_with = [](int priority_of_spinner) {
    return run([priority_of_spinner](World& world) {
      world.set_cpu(Cpu::one_fifo);
      world.set_points_max(10'000);
      const auto lock = std::make_shared<Lock>();
      const auto start = [&](const char* name, int priority, SimTime begin, SimTime held) {
        world.process("p").start(name, [=] {
          const sched_param parameters{.sched_priority = priority};
          pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
          std::this_thread::sleep_for(begin);
          pthread_spin_lock(&*lock);
          std::this_thread::sleep_for(held);
          pthread_spin_unlock(&*lock);
        });
      };
      start("owner", 10, 0ms, 0ms);
      start("spinner", priority_of_spinner, 1ms, 0ms);
      world.process("p").start("holder", [=] {
        const sched_param parameters{.sched_priority = 20};
        pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
        std::this_thread::sleep_for(500us);
        pthread_spin_lock(&*lock);
        // Works until the spinner takes the processor away.
        timespec time{};
        do {
          clock_gettime(CLOCK_MONOTONIC, &time);
        } while (time.tv_nsec < 1'100'000);
        pthread_spin_unlock(&*lock);
      });
    });
  };
  EXPECT_EQ(run_with(15), Outcome{});
  const Outcome outcome = run_with(30);
  EXPECT_EQ(outcome.kind, OutcomeKind::livelock);
  EXPECT_NE(outcome.message.find("p/spinner polls spin_lock spin-lock-1"), std::string::npos)
      << outcome.message;
}

}  // namespace
}  // namespace ltsim
