// Tasks: what is each task's own, how tasks are created and joined, and how they end badly.

#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cctype>
#include <cerrno>
#include <cfenv>
#include <cstdlib>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

class TasksTest : public WorldTest {};

void complain() { throw std::runtime_error{"no paper"}; }

thread_local int own_number = 42;

TEST_F(TasksTest, thread_locals_are_each_tasks_own_and_fresh_in_each_execution) {
  const Outcome outcome = run_randomly(100, [](World& world) {
    for (const int number : {1, 2, 3}) {
      world.process("p").start(std::to_string(number), [&world, number] {
        world.require(own_number == 42, "initial value");
        own_number = number;
        for (int i = 0; i < 5; ++i) {
          sched_yield();
          world.require(own_number == number, "kept across switches");
        }
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(own_number, 42);
}

TEST_F(TasksTest, floating_point_rounding_and_exception_flags_are_each_tasks_own) {
  const Outcome outcome = run_randomly(50, [](World& world) {
    for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD}) {
      world.process("p").start(std::to_string(rounding), [&world, rounding] {
        fesetround(rounding);
        feclearexcept(FE_ALL_EXCEPT);
        const int raised = rounding == FE_UPWARD ? FE_OVERFLOW : 0;
        feraiseexcept(raised);
        for (int i = 0; i < 5; ++i) {
          sched_yield();
          world.require(fegetround() == rounding, "rounding kept");
          world.require(fetestexcept(FE_OVERFLOW) == raised, "flags kept");
        }
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(fegetround(), FE_TONEAREST);
}

TEST_F(TasksTest, errno_is_each_tasks_own) {
  const Outcome outcome = run_randomly(50, [](World& world) {
    for (const int number : {1, 2}) {
      world.process("p").start(std::to_string(number), [&world, number] {
        world.require(errno == 0, "fresh");
        errno = number;
        sched_yield();
        world.require(errno == number, "kept");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

// Two tasks switched inside their catch blocks must each rethrow their own exception.
TEST_F(TasksTest, exceptions_in_flight_are_each_tasks_own) {
  const Outcome outcome = run_randomly(200, [](World& world) {
    for (const int number : {1, 2}) {
      world.process("p").start(std::to_string(number), [&world, number] {
        try {
          try {
            throw number;
          } catch (...) {
            sched_yield();
            throw;
          }
        } catch (int caught) {
          world.require(caught == number, "the task's own exception");
        }
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, the_character_classes_work_in_a_task) {  // libc sets them up per thread
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [&world] {
      volatile char digit = '7';
      world.require(std::isdigit(digit) != 0 && std::isalpha(digit) == 0, "isdigit");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, threads_are_created_joined_and_have_identities) {
  const Outcome outcome = run_randomly(100, [](World& world) {
    world.process("p").start("main", [&world] {
      std::atomic<int> sum = 0;
      std::vector<std::thread> threads;
      std::set<std::thread::id> identities;
      for (int i = 1; i <= 3; ++i) {
        threads.emplace_back([&sum, i] { sum += i; });
        identities.insert(threads.back().get_id());
      }
      for (std::thread& thread : threads) thread.join();
      world.require(sum == 6, "all ran");
      world.require(identities.size() == 3 && identities.count(std::this_thread::get_id()) == 0,
                    "identities");
      world.require(std::thread::hardware_concurrency() == 2, "the same machine everywhere");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, a_thread_returns_its_result_to_who_joins_it) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [&world] {
      int value = 5;
      pthread_t thread{};
      pthread_create(&thread, nullptr, [](void* argument) { return argument; }, &value);
      void* result = nullptr;
      world.require(pthread_join(thread, &result) == 0 && result == &value, "result");
      world.require(pthread_join(thread, nullptr) == ESRCH, "joined once");
      world.require(pthread_join(pthread_self(), nullptr) == EDEADLK, "not by itself");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, thread_local_objects_are_destroyed_when_their_task_ends) {
  static int destroyed = 0;
  struct Counted {
    int value = 1;
    ~Counted() { ++destroyed; }
  };
  destroyed = 0;
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [&world] {
      std::thread{[] {
        thread_local Counted counted;
        counted.value = 2;
      }}.join();
      world.require(destroyed == 1, "destroyed at the end of the thread");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, sleepers_wake_in_the_order_of_their_deadlines_and_cost_no_real_time) {
  std::vector<int> woken;
  SimTime ended{};
  const Outcome outcome = run([&](World& world) {
    woken.clear();
    for (const int hours : {3, 1, 2}) {
      world.process("p").start(std::to_string(hours), [&, hours] {
        std::this_thread::sleep_for(std::chrono::hours{hours});
        woken.push_back(hours);
        ended = world.now();
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_EQ(woken, (std::vector<int>{1, 2, 3}));
  EXPECT_GE(ended, 3h);
}

TEST_F(TasksTest, all_clocks_are_the_worlds) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [&world] {
      const auto steady = std::chrono::steady_clock::now();
      const auto wall = std::chrono::system_clock::now();
      const time_t seconds = time(nullptr);
      std::this_thread::sleep_for(90min);
      const auto passed = std::chrono::steady_clock::now() - steady;
      world.require(passed >= 90min && passed < 91min, "steady clock");
      const auto wall_passed = std::chrono::system_clock::now() - wall;
      world.require(wall_passed >= 90min && wall_passed < 91min, "wall clock");
      world.require(seconds == 1'767'225'600, "2026-01-01T00:00:00Z");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, a_loop_that_polls_the_clock_ends) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {
      const auto deadline = std::chrono::steady_clock::now() + 1ms;
      while (std::chrono::steady_clock::now() < deadline) {
      }
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, a_loop_without_end_is_a_livelock) {
  const Outcome outcome = run([](World& world) {
    world.set_points_max(1000);
    const auto stop = std::make_shared<std::atomic<bool>>(false);
    world.process("p").start("main", [stop] {
      while (!stop->load()) {
      }
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::livelock);
  EXPECT_NE(outcome.message.find("1000 scheduling points"), std::string::npos) << outcome.message;
}

TEST_F(TasksTest, a_task_that_yields_lets_the_others_run_even_by_default) {
  const Outcome outcome = run([](World& world) {
    const auto ready = std::make_shared<std::atomic<bool>>(false);
    world.process("p").start("waits", [ready] {
      while (!ready->load()) std::this_thread::yield();
    });
    world.process("p").start("sets", [ready] { ready->store(true); });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(TasksTest, an_exception_that_nobody_catches_is_a_crash) {
  const Outcome outcome = run(
      [](World& world) { world.process("p").start("main", [] { throw std::runtime_error{"no paper"}; }); });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::crash, "p/main: nobody caught the exception \"no paper\""}));
}

TEST_F(TasksTest, an_exception_that_meets_noexcept_is_a_crash) {
  const Outcome outcome =
      run([](World& world) { world.process("p").start("main", []() noexcept { complain(); }); });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::crash, "p/main: nobody caught the exception \"no paper\""}));
}

TEST_F(TasksTest, abort_is_an_assertion) {
  const Outcome outcome = run([](World& world) { world.process("p").start("main", [] { std::abort(); }); });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::assertion, "p/main: abort() was called"}));
}

TEST_F(TasksTest, a_bad_address_is_a_crash_and_the_next_execution_is_whole) {
  const auto dereference = [](World& world) {
    world.process("p").start("main", [] {
      volatile std::uintptr_t nowhere =
          0;  // volatile twice: the compiler may neither know it nor leave the store out
      *reinterpret_cast<volatile int*>(nowhere) = 1;
    });
  };
  for (int i = 0; i < 3; ++i) {
    const Outcome outcome = run(dereference);
    EXPECT_EQ(outcome, (Outcome{OutcomeKind::crash, "p/main: Segmentation fault (SIGSEGV)"}));
    EXPECT_EQ(run([](World& world) { world.process("p").start("main", [] {}); }), Outcome{});
  }
}

/// Deeper than any stack; the compiler cannot see that it never comes to an end.
int recurse(const volatile int& depth_max, int depth) {
  volatile char frame[1024];
  frame[0] = static_cast<char>(depth);
  return depth == depth_max ? 0 : recurse(depth_max, depth + 1) + frame[0];
}

TEST_F(TasksTest, a_stack_overflow_is_a_crash_that_says_so) {
  const Outcome outcome = run([](World& world) {
    world.process("p").start("main", [] {
      const volatile int never = -1;
      recurse(never, 0);
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::crash);
  EXPECT_NE(outcome.message.find("stack overflow"), std::string::npos) << outcome.message;
}

TEST_F(TasksTest, what_the_world_does_not_simulate_is_refused_by_name) {
  const auto refusal = [](void (*call)()) {
    return run([call](World& world) { world.process("p").start("main", [call] { call(); }); });
  };
  const auto named = [](const char* name) {
    return Outcome{OutcomeKind::unsupported,
                   std::string{"p/main called "} + name + ", which ltsim does not simulate"};
  };
  EXPECT_EQ(refusal([] { static_cast<void>(fork()); }), named("fork"));
  EXPECT_EQ(refusal([] { static_cast<void>(pthread_kill(pthread_self(), SIGUSR1)); }), named("pthread_kill"));
  EXPECT_EQ(refusal([] { std::exit(0); }).kind, OutcomeKind::unsupported);
  EXPECT_EQ(refusal([] { syscall(9999); }).kind, OutcomeKind::unsupported);
}

TEST_F(TasksTest, outside_a_task_every_call_is_the_real_one) {
  EXPECT_GT(std::chrono::system_clock::now().time_since_epoch(), std::chrono::years{50});
  std::thread{[] { EXPECT_EQ(current_task, nullptr); }}.join();
  const pid_t child = fork();
  if (child == 0) _exit(7);
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
}  // namespace ltsim
