// What lives longer or shorter than an execution: objects of the scenario, statics, real kernel objects; and
// the limits of a world.

#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "sim_clock/scenario/interrupt.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

class LifetimeTest : public WorldTest {};

TEST_F(LifetimeTest, a_static_variable_that_two_tasks_reach_together_is_initialised_once) {
  // Fresh in each round: the guard of one static can be taken once only.
  const auto reach = [](auto tag) {
    static const int value = [] {
      std::this_thread::yield();
      return decltype(tag)::value;
    }();
    return value;
  };
  const auto both_reach = [&](auto tag) {
    return run_randomly(1, [&, tag](World& world) {
      for (const char* name : {"one", "two"}) {
        world.process("p").start(name,
                                 [&world, &reach, tag] { world.require(reach(tag) == tag.value, "value"); });
      }
    });
  };
  EXPECT_EQ(both_reach(std::integral_constant<int, 1>{}), Outcome{});
  EXPECT_EQ(both_reach(std::integral_constant<int, 2>{}), Outcome{});
  EXPECT_EQ(both_reach(std::integral_constant<int, 3>{}), Outcome{});
  EXPECT_EQ(both_reach(std::integral_constant<int, 4>{}), Outcome{});
}

TEST_F(LifetimeTest, a_thread_of_a_task_can_be_joined_after_the_run) {
  std::optional<std::thread> thread;
  const Outcome outcome =
      run([&](World& world) { world.process("p").start("main", [&] { thread.emplace([] {}); }); });
  EXPECT_EQ(outcome, Outcome{});
  ASSERT_TRUE(thread);
  thread->join();
}

TEST_F(LifetimeTest, a_mutex_that_a_dropped_task_held_can_be_locked_after_the_run) {
  std::mutex mutex;
  const Outcome outcome = run([&](World& world) {
    world.process("p").start("main", [&] {
      mutex.lock();
      std::abort();
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::assertion);
  const std::lock_guard lock{mutex};
}

TEST_F(LifetimeTest, what_a_dropped_task_captured_is_not_destroyed) {
  const Outcome outcome = run([](World& world) {
    const auto thread = std::make_shared<std::thread>();  // destroying a joinable one would end the program
    world.process("p").start("main", [thread] {
      *thread = std::thread{[] { std::this_thread::sleep_for(1h); }};
      std::abort();
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::assertion);
  EXPECT_EQ(run([](World& world) { world.process("p").start("main", [] {}); }), Outcome{});
}

TEST_F(LifetimeTest, real_kernel_objects_are_refused_while_the_scenario_sets_up) {
  const auto refusal = [](void (*call)()) { return run([call](World&) { call(); }); };
  const std::array<Outcome, 4> outcomes{
      refusal([] { EXPECT_EQ(sem_open("/ltsim-real", O_CREAT, 0600, 0U), SEM_FAILED); }),
      refusal([] { EXPECT_EQ(shm_open("/ltsim-real", O_CREAT | O_RDWR, 0600), -1); }), refusal([] {
        sem_t semaphore;
        EXPECT_EQ(sem_init(&semaphore, 0, 0), -1);
      }),
      refusal([] {
        pthread_t thread{};
        EXPECT_NE(pthread_create(&thread, nullptr, [](void* p) { return p; }, nullptr), 0);
      })};
  for (const Outcome& outcome : outcomes) {
    EXPECT_EQ(outcome.kind, OutcomeKind::unsupported);
    EXPECT_NE(outcome.message.find("outside its tasks"), std::string::npos) << outcome.message;
  }
}

TEST_F(LifetimeTest, ways_to_end_the_simulator_are_refused) {
  for (void (*const call)() :
       std::initializer_list<void (*)()>{[] { std::_Exit(0); }, [] { std::quick_exit(0); }, [] { _exit(0); },
                                         [] { execl("/bin/true", "true", nullptr); }}) {
    EXPECT_EQ(run([call](World& world) { world.process("p").start("main", [call] { call(); }); }).kind,
              OutcomeKind::unsupported);
  }
}

TEST_F(LifetimeTest, a_double_free_is_a_crash) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {
      void* volatile memory = std::malloc(100);
      std::free(memory);
      std::free(memory);
    });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::crash, "p/main: Aborted (SIGABRT)"}));
}

TEST_F(LifetimeTest, running_a_second_time_does_nothing) {
  int runs = 0;
  const Outcome outcome = run([&](World& world) {
    world.process("p").start("main", [&] { ++runs; });
    world.run();
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(runs, 1);
}

TEST_F(LifetimeTest, two_tasks_of_one_name_are_refused) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {});
    world.process("p").start("main", [] {});
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::unsupported);
}

TEST_F(LifetimeTest, a_world_takes_as_many_tasks_and_processes_as_it_says_and_refuses_one_more) {
  for (const bool one_more : {false, true}) {
    const auto tasks = [one_more](World& world) {
      for (std::size_t i = 0; i < tasks_max + (one_more ? 1 : 0); ++i) {
        world.process("p").start(std::to_string(i), [] {});
      }
    };
    const auto processes = [one_more](World& world) {
      for (std::size_t i = 0; i < Segments::processes_max + (one_more ? 1 : 0); ++i) {
        world.process(std::to_string(i)).start("main", [] {});
      }
    };
    EXPECT_EQ(run(tasks).kind, one_more ? OutcomeKind::unsupported : OutcomeKind::passed);
    EXPECT_EQ(run(processes).kind, one_more ? OutcomeKind::unsupported : OutcomeKind::passed);
  }
}

TEST_F(LifetimeTest, a_world_takes_as_many_segments_and_mappings_as_it_says_and_refuses_one_more) {
  for (const std::size_t one_more : {0U, 1U}) {
    const auto segments = [one_more](World& world) {
      world.process("p").start("main", [one_more] {
        for (std::size_t i = 0; i < Segments::segments_max + one_more; ++i) {
          shm_open(("/s" + std::to_string(i)).c_str(), O_CREAT | O_RDWR, 0600);
        }
      });
    };
    const auto mappings = [one_more](World& world) {
      world.process("p").start("main", [one_more] {
        const int descriptor = shm_open("/s", O_CREAT | O_RDWR, 0600);
        ftruncate(descriptor, 10);
        for (std::size_t i = 0; i < Segments::mappings_max + one_more; ++i) {
          mmap(nullptr, 10, PROT_READ, MAP_SHARED, descriptor, 0);
        }
      });
    };
    const auto expected = one_more == 1 ? OutcomeKind::unsupported : OutcomeKind::passed;
    EXPECT_EQ(run(segments).kind, expected);
    EXPECT_EQ(run(mappings).kind, expected);
  }
}

TEST_F(LifetimeTest, random_bytes_differ_within_an_execution_and_are_the_same_in_each) {
  std::array<std::array<std::uint64_t, 2>, 2> drawn{};
  for (auto& execution : drawn) {
    EXPECT_EQ(run([&](World& world) {
                world.process("p").start("main", [&] {
                  for (std::uint64_t& bytes : execution) getrandom(&bytes, sizeof bytes, 0);
                });
              }),
              Outcome{});
  }
  EXPECT_NE(drawn[0][0], drawn[0][1]);
  EXPECT_EQ(drawn[0], drawn[1]);
}

TEST_F(LifetimeTest, random_bytes_of_a_process_do_not_depend_on_how_often_others_draw) {
  const auto drawn_after = [](unsigned others) {
    std::uint64_t drawn = 0;
    EXPECT_EQ(run([&](World& world) {
                world.process("others").start("main", [others] {
                  std::uint64_t bytes = 0;
                  for (unsigned i = 0; i < others; ++i) getrandom(&bytes, sizeof bytes, 0);
                });
                world.process("p").start("main", [&drawn] { getrandom(&drawn, sizeof drawn, 0); });
              }),
              Outcome{});
    return drawn;
  };
  EXPECT_EQ(drawn_after(0), drawn_after(2));
}

TEST_F(LifetimeTest, a_signal_that_asks_to_stop_is_no_step_of_the_task_that_it_interrupts) {
  const InterruptGuard guard;
  const long own = getpid();
  std::uint64_t steps = 1;
  EXPECT_EQ(
      run([&](World& world) {
        world.process("p").start("main", [&] {
          const std::uint64_t before = world.scheduler().points();
          // raise() is refused, and only a signal from outside is what is meant.
          long result = SYS_kill;
          asm volatile("syscall" : "+a"(result) : "D"(own), "S"(long{SIGTERM}) : "rcx", "r11", "memory");
          steps = world.scheduler().points() - before;
        });
      }),
      Outcome{});
  EXPECT_EQ(InterruptGuard::signal(), SIGTERM);
  EXPECT_EQ(steps, 0U);
}

TEST_F(LifetimeTest, an_execution_that_has_shown_enough_ends_where_it_stands_and_has_passed) {
  const auto run_until_enough = [](const std::function<void(World&)>& enough) {
    int looks = 0;
    const Outcome outcome = run([&](World& world) {
      world.process("p").start("waits", [&] {
        for (;;) {
          std::this_thread::sleep_for(1ms);
          if (++looks == 3) enough(world);
        }
      });
    });
    EXPECT_EQ(looks, 3);
    return outcome;
  };
  EXPECT_EQ(run_until_enough([](World& world) { world.finish(); }), Outcome{});
  EXPECT_EQ(run_until_enough([](World& world) { world.whenever_idle([&world] { world.finish(); }); }),
            Outcome{});
}

TEST_F(LifetimeTest, a_mutex_held_by_who_was_under_way_when_enough_was_seen_is_no_leak) {
  std::mutex mutex;
  EXPECT_EQ(run([&](World& world) {
              world.process("p").start("works", [&] {
                const std::lock_guard lock{mutex};
                std::this_thread::sleep_for(2ms);
              });
              world.process("p").start("has-seen-enough", [&world] {
                std::this_thread::sleep_for(1ms);
                world.finish();
              });
            }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
