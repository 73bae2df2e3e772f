// One processor that honours priorities: who can run is decided by priority, and inversion is real.

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <memory>
#include <semaphore>
#include <string>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

class OneFifoTest : public CallsTest {
 protected:
  static void become(int policy, int priority) {
    const sched_param parameters{.sched_priority = priority};
    EXPECT_EQ(pthread_setschedparam(pthread_self(), policy, &parameters), 0);
  }

  /// Some steps that others could interrupt.
  static void work(int steps) {
    std::atomic<int> counter{0};
    for (int i = 0; i < steps; ++i) ++counter;
  }

  /// L takes the lock, H needs it, M only works, long: how long H waited.
  static void inversion(World& world, int protocol, pthread_mutex_t* mutex, SimTime& waited) {
    world.set_cpu(Cpu::one_fifo);
    world.process("p").start("middle", [] {
      become(SCHED_FIFO, 2);
      std::this_thread::sleep_for(10us);
      work(5000);  // 500 us
    });
    world.process("p").start("high", [mutex, &world, &waited] {
      become(SCHED_FIFO, 3);
      std::this_thread::sleep_for(5us);
      const SimTime begin = world.now();
      pthread_mutex_lock(mutex);
      waited = world.now() - begin;
      pthread_mutex_unlock(mutex);
    });
    world.process("p").start("low", [mutex, protocol] {
      pthread_mutexattr_t attributes;
      pthread_mutexattr_init(&attributes);
      pthread_mutexattr_setprotocol(&attributes, protocol);
      pthread_mutex_init(mutex, &attributes);
      become(SCHED_FIFO, 1);
      pthread_mutex_lock(mutex);
      work(200);  // 20 us
      pthread_mutex_unlock(mutex);
    });
  }
};

TEST_F(OneFifoTest, a_task_of_higher_priority_runs_until_it_blocks_whatever_the_strategy_wants) {
  std::string order;
  const Outcome outcome = run_randomly(50, [&order](World& world) {
    world.set_cpu(Cpu::one_fifo);
    order.clear();
    const auto gate = std::make_shared<std::counting_semaphore<>>(0);
    for (const int priority : {10, 30, 20}) {
      world.process("p").start(std::to_string(priority), [&order, gate, priority] {
        become(SCHED_FIFO, priority);
        gate->acquire();
        for (int i = 0; i < 3; ++i) {
          work(5);
          order += std::to_string(priority) + " ";
        }
      });
    }
    world.process("p").start("opens", [gate, &world] {
      while (blocked_count(world, {"10", "20", "30"}) != 3) std::this_thread::sleep_for(1ms);
      become(SCHED_FIFO, 99);
      gate->release(3);
    });
  });
  EXPECT_EQ(order, "30 30 30 20 20 20 10 10 10 ");
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(OneFifoTest, equals_take_turns_only_when_they_yield) {
  for (const bool yields : {false, true}) {
    std::string order;
    const Outcome outcome = run([&](World& world) {
      world.set_cpu(Cpu::one_fifo);
      for (const char* name : {"a", "b"}) {
        world.process("p").start(name, [&order, name, yields] {
          become(SCHED_FIFO, 5);
          std::this_thread::sleep_for(1ms);
          for (int i = 0; i < 2; ++i) {
            work(3);
            order += name;
            if (yields) sched_yield();
          }
        });
      }
    });
    EXPECT_EQ(outcome, Outcome{});
    EXPECT_EQ(order, yields ? "abab" : "aabb");
  }
}

TEST_F(OneFifoTest, a_task_that_polls_starves_those_below_it) {
  const Outcome outcome = run([](World& world) {
    world.set_cpu(Cpu::one_fifo);
    world.set_points_max(10'000);
    const auto flag = std::make_shared<std::atomic<bool>>(false);
    world.process("p").start("poller", [flag] {
      become(SCHED_FIFO, 5);
      while (!flag->load()) {
      }
    });
    world.process("p").start("worker", [flag] {
      become(SCHED_FIFO, 4);
      flag->store(true);
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::livelock) << outcome.message;
}

TEST_F(OneFifoTest, without_inheritance_the_middle_task_holds_the_high_one_up) {
  SimTime waited{0};
  pthread_mutex_t mutex;
  EXPECT_EQ(run([&](World& world) { inversion(world, PTHREAD_PRIO_NONE, &mutex, waited); }), Outcome{});
  EXPECT_GT(waited, 400us);
}

TEST_F(OneFifoTest, with_inheritance_the_low_task_finishes_first) {
  SimTime waited{0};
  pthread_mutex_t mutex;
  EXPECT_EQ(run([&](World& world) { inversion(world, PTHREAD_PRIO_INHERIT, &mutex, waited); }), Outcome{});
  EXPECT_LT(waited, 60us);
  EXPECT_GT(waited, 10us);
}

TEST_F(OneFifoTest, a_lock_given_back_goes_to_who_has_been_lent_a_priority_meanwhile) {
  SimTime waited{0};
  pthread_mutex_t inner;
  pthread_mutex_t outer;
  const Outcome outcome = run([&](World& world) {
    world.set_cpu(Cpu::one_fifo);
    // Holds `inner` until both others wait for it; `two` is woken first, `one` is then lent the priority of `high`.
    world.process("p").start("holder", [&] {
      for (pthread_mutex_t* const mutex : {&inner, &outer}) {
        pthread_mutexattr_t attributes;
        pthread_mutexattr_init(&attributes);
        pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
        pthread_mutex_init(mutex, &attributes);
      }
      become(SCHED_FIFO, 9);
      pthread_mutex_lock(&inner);
      std::this_thread::sleep_for(20us);
      pthread_mutex_unlock(&inner);
    });
    world.process("p").start("one", [&] {
      become(SCHED_FIFO, 1);
      pthread_mutex_lock(&outer);
      pthread_mutex_lock(&inner);
      pthread_mutex_unlock(&inner);
      pthread_mutex_unlock(&outer);
    });
    world.process("p").start("two", [&] {
      become(SCHED_FIFO, 2);
      pthread_mutex_lock(&inner);
      pthread_mutex_unlock(&inner);
    });
    world.process("p").start("middle", [] {
      become(SCHED_FIFO, 5);
      std::this_thread::sleep_for(10us);
      work(5000);  // 500 us
    });
    world.process("p").start("high", [&] {
      become(SCHED_FIFO, 8);
      std::this_thread::sleep_for(50us);
      const SimTime begin = world.now();
      pthread_mutex_lock(&outer);
      waited = world.now() - begin;
      pthread_mutex_unlock(&outer);
    });
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_LT(waited, 20us);
}

TEST_F(OneFifoTest, a_thread_has_the_priority_of_its_attributes_or_of_its_creator) {
  const Outcome outcome = run_task([](World&) {
    become(SCHED_RR, 7);
    const auto priority_with = [](const pthread_attr_t* attributes) {
      static int policy;
      static sched_param parameters;
      pthread_t thread;
      pthread_create(
          &thread, attributes,
          [](void*) -> void* {
            pthread_getschedparam(pthread_self(), &policy, &parameters);
            return nullptr;
          },
          nullptr);
      pthread_join(thread, nullptr);
      return policy * 100 + parameters.sched_priority;
    };
    EXPECT_EQ(priority_with(nullptr), SCHED_RR * 100 + 7);
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    const sched_param parameters{.sched_priority = 42};
    pthread_attr_setschedparam(&attributes, &parameters);
    EXPECT_EQ(priority_with(&attributes), SCHED_FIFO * 100 + 42);
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(OneFifoTest, what_linux_refuses_is_refused) {
  const Outcome outcome = run_task([](World&) {
    const sched_param zero{.sched_priority = 0};
    const sched_param hundred{.sched_priority = 100};
    EXPECT_EQ(pthread_setschedparam(pthread_self(), SCHED_FIFO, &zero), EINVAL);
    EXPECT_EQ(pthread_setschedparam(pthread_self(), SCHED_FIFO, &hundred), EINVAL);
    EXPECT_EQ(sched_setscheduler(0, SCHED_FIFO, &hundred), -1);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
  });
  EXPECT_EQ(outcome, Outcome{});
}

}  // namespace
}  // namespace ltsim
