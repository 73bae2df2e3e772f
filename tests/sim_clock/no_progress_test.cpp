// What is said of executions that get nowhere, and of locks that are never given back.

#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

class NoProgressTest : public CallsTest {
 protected:
  struct Locks {
    std::mutex a, b;
  };
};

// --- deadlocks ---

TEST_F(NoProgressTest, two_locks_in_opposite_order_are_a_cycle_of_two) {
  const Outcome outcome = run([](World& world) {
    const auto locks = std::make_shared<Locks>();
    world.process("p").start("one", [locks] {
      const std::lock_guard first{locks->a};
      std::this_thread::sleep_for(1ms);
      const std::lock_guard second{locks->b};
    });
    world.process("p").start("two", [locks] {
      const std::lock_guard first{locks->b};
      std::this_thread::sleep_for(1ms);
      const std::lock_guard second{locks->a};
    });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::deadlock,
                              "a cycle of 2: p/one waits in mutex_lock mutex-2, held by p/two; "
                              "p/two waits in mutex_lock mutex-1, held by p/one"}));
}

TEST_F(NoProgressTest, who_waits_for_a_member_of_a_cycle_comes_after_it) {
  const Outcome outcome = run([](World& world) {
    const auto mutex = std::make_shared<std::mutex>();
    world.process("p").start("guest", [mutex] {
      std::this_thread::sleep_for(1ms);
      mutex->lock();
    });
    world.process("p").start("owner", [mutex] {
      mutex->lock();
      mutex->lock();
    });
  });
  EXPECT_EQ(outcome.message,
            "a cycle of 1: p/owner waits in mutex_lock mutex-1, held by p/owner; "
            "p/guest waits in mutex_lock mutex-1, held by p/owner");
}

TEST_F(NoProgressTest, a_joined_thread_that_waits_for_the_joiner_is_in_a_cycle_with_it) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {
      std::mutex mutex;
      mutex.lock();
      std::thread thread{[&] { mutex.lock(); }};
      thread.join();
    });
  });
  EXPECT_EQ(outcome.message,
            "a cycle of 2: p/main waits in thread_join for p/thread-1; "
            "p/thread-1 waits in mutex_lock mutex-1, held by p/main");
}

TEST_F(NoProgressTest, a_lock_whose_owner_has_ended_is_told) {
  const Outcome outcome = run([](World& world) {
    const auto mutex = std::make_shared<std::mutex>();
    world.process("p").start("one", [mutex] { mutex->lock(); });
    world.process("p").start("two", [mutex] { mutex->lock(); });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::deadlock,
                              "p/two waits in mutex_lock mutex-1, held by p/one, which has ended"}));
}

TEST_F(NoProgressTest, who_sleeps_with_nobody_left_to_wake_it_is_told) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("posted", [] { sem_wait(sem_open("/doorbell", O_CREAT, 0600, 0U)); });
    world.process("p").start("signalled", [] {
      std::mutex mutex;
      std::condition_variable condition;
      std::unique_lock lock{mutex};
      condition.wait(lock);
    });
  });
  EXPECT_EQ(outcome.message,
            "p/posted waits in sem_wait doorbell, and nobody is left to post it; "
            "p/signalled waits in cond_wait mutex-1, and nobody is left to signal its condition");
}

TEST_F(NoProgressTest, who_was_signalled_waits_for_the_owner_of_the_mutex_and_not_for_a_signal) {
  const Outcome outcome = run([](World& world) {
    struct Shared {
      std::mutex mutex;
      std::condition_variable condition;
    };
    const auto shared = std::make_shared<Shared>();
    world.process("p").start("waiter", [shared] {
      std::unique_lock lock{shared->mutex};
      shared->condition.wait(lock);
    });
    world.process("p").start("notifier", [shared] {
      shared->mutex.lock();
      shared->condition.notify_one();
    });
  });
  EXPECT_EQ(outcome.message, "p/waiter waits in cond_wait mutex-1, held by p/notifier, which has ended");
}

// --- livelocks ---

TEST_F(NoProgressTest, a_livelock_names_who_polls_what_and_who_waits_for_them) {
  for (std::uint64_t points = 1000; points < 1012; ++points) {  // wherever in their loops it ends
    const Outcome outcome = run([points](World& world) {
      world.set_points_max(points);
      world.name_region("segment", 0, 4, "segment.state");
      world.name_region("segment", 4, 4, "segment.count");
      world.name_region("segment", 8, 4, "segment.stop");
      world.process("p").start("polls", [] {
        auto* const words = static_cast<std::atomic<int>*>(map_segment());
        while (words[0].load() == 0 && words[2].load() == 0) std::this_thread::sleep_for(1us);
      });
      world.process("p").start("repeats", [] {
        auto* const words = static_cast<std::atomic<int>*>(map_segment());
        for (int i = 0; words[0].load() == 0; ++i) words[1].store(i);
      });
      world.process("p").start("sleeps", [] {
        for (;;) std::this_thread::sleep_for(1us);
      });
      world.process("p").start("waits", [] { sem_wait(sem_open("/doorbell", O_CREAT, 0600, 0U)); });
    });
    EXPECT_EQ(outcome.kind, OutcomeKind::livelock);
    EXPECT_EQ(outcome.message.substr(outcome.message.find(';')),
              "; p/polls polls atomic_load segment.state; p/repeats repeats atomic_store segment.count; "
              "p/sleeps lets time pass; p/waits waits in sem_wait doorbell");
  }
}

TEST_F(NoProgressTest, who_polls_for_one_that_sleeps_longer_than_the_execution_has_points_is_no_livelock) {
  const Outcome outcome = run([](World& world) {
    world.set_points_max(1000);
    const auto flag = std::make_shared<std::atomic<int>>(0);
    world.process("p").start("polls", [flag] {
      while (flag->load() == 0) sched_yield();
    });
    world.process("p").start("sleeps", [flag] {
      std::this_thread::sleep_for(1s);
      flag->store(1);
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

// --- locks held at the end ---

TEST_F(NoProgressTest, a_lock_that_its_owner_never_gives_back_is_a_leak) {
  const Outcome outcome = run([](World& world) {
    const auto locks = std::make_shared<Locks>();
    world.process("p").start("one", [locks] { locks->a.lock(); });
    world.process("p").start("two", [locks] { const std::lock_guard lock{locks->b}; });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::leak, "mutex-1 is still held by p/one, which has ended"}));
}

TEST_F(NoProgressTest, a_lock_whose_memory_is_gone_is_a_leak_as_well) {
  const Outcome outcome = run_task([](World&) { std::make_unique<std::mutex>()->lock(); });
  EXPECT_EQ(outcome.kind, OutcomeKind::leak);
}

TEST_F(NoProgressTest, a_recursive_lock_given_back_once_too_seldom_is_a_leak) {
  const Outcome outcome = run_task([](World&) {
    std::recursive_mutex mutex;
    mutex.lock();
    mutex.lock();
    mutex.unlock();
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::leak);
}

TEST_F(NoProgressTest, a_lock_held_after_a_wait_for_a_condition_and_given_back_is_no_leak) {
  const Outcome outcome = run_task([](World&) {
    std::mutex mutex;
    std::condition_variable condition;
    std::unique_lock lock{mutex};
    condition.wait_for(lock, 1ms);
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(NoProgressTest, a_leak_is_not_told_where_something_worse_happened) {
  const Outcome outcome = run([](World& world) {
    const auto locks = std::make_shared<Locks>();
    world.process("p").start("main", [locks] { locks->a.lock(); });
    world.run();
    world.require(false, "what the scenario checks at its end");
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "what the scenario checks at its end"}));
}

}  // namespace
}  // namespace ltsim
