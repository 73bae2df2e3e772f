// Barriers: pthread_barrier_*.

#include <pthread.h>

#include <cerrno>
#include <memory>
#include <thread>
#include <vector>

#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

class BarriersTest : public RacesTest {
 protected:
  struct Barrier {
    pthread_barrier_t barrier;
    explicit Barrier(unsigned count) { pthread_barrier_init(&barrier, nullptr, count); }
    pthread_barrier_t* operator&() { return &barrier; }
  };
};

TEST_F(BarriersTest, all_go_on_when_the_last_has_come_and_one_of_them_is_told_apart) {
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = run_randomly(100, [](World& world) {
      struct Shared {
        Barrier barrier{3};
        std::array<int, 4> come{};  // by round
        std::array<int, 4> serial{};
      };
      const auto shared = std::make_shared<Shared>();
      for (const char* name : {"one", "two", "three"}) {
        world.process("p").start(name, [&world, shared] {
          for (std::size_t round = 0; round < 4; ++round) {
            ++shared->come[round];
            const int result = pthread_barrier_wait(&shared->barrier);
            world.require(result == 0 || result == PTHREAD_BARRIER_SERIAL_THREAD, "no error");
            world.require(shared->come[round] == 3, "all have come");
            if (result == PTHREAD_BARRIER_SERIAL_THREAD) ++shared->serial[round];
          }
          pthread_barrier_wait(&shared->barrier);
          world.require(shared->serial == std::array{1, 1, 1, 1}, "one of each round");
        });
      }
    });
    EXPECT_EQ(outcome, Outcome{});
  }
}

TEST_F(BarriersTest, it_can_be_destroyed_by_who_has_passed_it_and_made_again) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_barrier_t barrier;
              world.require(pthread_barrier_init(&barrier, nullptr, 0) == EINVAL, "for nobody");
              pthread_barrier_init(&barrier, nullptr, 2);
              std::thread other{[&] { pthread_barrier_wait(&barrier); }};
              pthread_barrier_wait(&barrier);
              world.require(pthread_barrier_destroy(&barrier) == 0, "destroyed");
              pthread_barrier_init(&barrier, nullptr, 1);
              world.require(pthread_barrier_wait(&barrier) == PTHREAD_BARRIER_SERIAL_THREAD, "alone");
              other.join();
            }),
            Outcome{});
}

TEST_F(BarriersTest, what_is_done_before_it_is_known_after_it) {
  const auto pass = [](Memory& memory, bool waits) {
    Barrier barrier{2};
    std::thread writer{[&] {
      write(memory.value);
      if (waits) pthread_barrier_wait(&barrier);
    }};
    if (waits) {
      pthread_barrier_wait(&barrier);
    } else {
      std::this_thread::sleep_for(1ms);
    }
    read(memory.value);
    writer.join();
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, true); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, false); }).kind, race);
}

TEST_F(BarriersTest, who_leaves_late_does_not_come_after_the_next_round) {
  EXPECT_EQ(run_alone([](Memory& m) {
              Barrier barrier{2};
              std::thread late{[&] {
                pthread_barrier_wait(&barrier);
                std::this_thread::sleep_for(2ms);
                read(m.value);  // the writer is at the barrier again, which proves nothing
                pthread_barrier_wait(&barrier);
              }};
              std::this_thread::sleep_for(1ms);
              pthread_barrier_wait(&barrier);  // the last to come, and the first to go on
              write(m.value);
              pthread_barrier_wait(&barrier);
              late.join();
            }).kind,
            race);
}

TEST_F(BarriersTest, those_of_one_round_do_not_come_after_those_of_another) {
  EXPECT_EQ(run_alone([](Memory& m) {
              Barrier barrier{2};
              const auto pass = [&] { pthread_barrier_wait(&barrier); };
              std::thread writer{[&] {
                write(m.value);
                pass();
              }};
              std::thread second{pass};
              std::thread third{[&] {
                std::this_thread::sleep_for(1ms);
                pass();
                read(m.value);
              }};
              std::thread fourth{[&] {
                std::this_thread::sleep_for(1ms);
                pass();
              }};
              for (std::thread* const thread : {&writer, &second, &third, &fourth}) thread->join();
            }).kind,
            race);
}

TEST_F(BarriersTest, what_goes_wrong_with_it_is_told) {
  EXPECT_EQ(run([](World& world) {
              const auto barrier = std::make_shared<Barrier>(3U);
              for (const char* name : {"one", "two"})
                world.process("p").start(name, [barrier] { pthread_barrier_wait(&*barrier); });
            }),
            (Outcome{OutcomeKind::deadlock,
                     "p/one waits in barrier_wait barrier-1, where 2 of 3 have come; "
                     "p/two waits in barrier_wait barrier-1, where 2 of 3 have come"}));
  EXPECT_EQ(
      run([](World& world) {
        const auto barrier = std::make_shared<Barrier>(3U);
        world.process("p").start("waiter", [barrier] { pthread_barrier_wait(&*barrier); });
        world.process("p").start("destroyer", [barrier] { pthread_barrier_destroy(&*barrier); });
      }),
      (Outcome{OutcomeKind::assertion, "barrier-1 is destroyed by p/destroyer while p/waiter waits at it"}));
  EXPECT_EQ(run_task([](World&) {
              pthread_barrier_t never_made{};
              pthread_barrier_wait(&never_made);
            }),
            (Outcome{OutcomeKind::crash, "barrier_wait on memory that holds no barrier"}));
}

TEST_F(BarriersTest, one_made_for_it_works_across_processes_and_another_one_wakes_nobody_there) {
  for (const int shared : {PTHREAD_PROCESS_SHARED, PTHREAD_PROCESS_PRIVATE}) {
    const Outcome outcome = run([shared](World& world) {
      for (const char* name : {"a", "b"}) {
        world.process(name).start("main", [shared, name] {
          auto* const barrier = static_cast<pthread_barrier_t*>(map_segment());
          if (*name == 'a') {
            pthread_barrierattr_t attributes;
            pthread_barrierattr_init(&attributes);
            pthread_barrierattr_setpshared(&attributes, shared);
            pthread_barrier_init(barrier, &attributes, 2);
          }
          pthread_barrier_wait(barrier);
        });
      }
    });
    EXPECT_EQ(outcome.kind, shared == PTHREAD_PROCESS_SHARED ? OutcomeKind::passed : OutcomeKind::deadlock)
        << outcome.message;
  }
}

TEST_F(BarriersTest, one_at_which_a_dropped_task_waited_is_empty_in_the_next_execution) {
  Barrier barrier{2};
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(
        run([&](World& world) { world.process("p").start("main", [&] { pthread_barrier_wait(&barrier); }); }),
        (Outcome{OutcomeKind::deadlock, "p/main waits in barrier_wait barrier-1, where 1 of 2 have come"}));
  }
}

}  // namespace
}  // namespace ltsim
