// Static variables that are initialised when they are first reached. The guard of one can be taken once only, so each test, and each
// of its executions, has statics of its own; some test calls the compiler's functions, with a guard that can be put back.

#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/sim_clock/races_fixture.hpp"

// Compilers have declarations of their own.
extern "C" int guard_acquire(std::uint64_t* guard) asm("__cxa_guard_acquire");
extern "C" void guard_release(std::uint64_t* guard) noexcept asm("__cxa_guard_release");
extern "C" void guard_abort(std::uint64_t* guard) noexcept asm("__cxa_guard_abort");

namespace ltsim {
namespace {

class StaticGuardsTest : public RacesTest {
 protected:
  /// What the compiler makes of reaching a static variable.
  template <typename Initialise>
  static void reach(std::uint64_t& guard, const Initialise& initialise) {
    if (std::atomic_ref{reinterpret_cast<std::uint8_t&>(guard)}.load(std::memory_order_acquire) != 0) return;
    if (guard_acquire(&guard) == 0) return;
    try {
      initialise();
    } catch (...) {
      guard_abort(&guard);
      throw;
    }
    guard_release(&guard);
  }
};

TEST_F(StaticGuardsTest, it_is_initialised_once_and_all_others_find_it_there) {
  const Outcome outcome = run_randomly(300, [](World& world) {
    struct Shared {
      std::uint64_t guard = 0;
      std::atomic<int> begun = 0;
      std::atomic<int> done = 0;
    };
    const auto shared = std::make_shared<Shared>();
    for (const char* name : {"one", "two", "three"}) {
      world.process("p").start(name, [shared, &world] {
        reach(shared->guard, [&] {
          ++shared->begun;
          std::this_thread::yield();
          ++shared->done;
        });
        world.require(shared->begun == 1 && shared->done == 1, "once, and it is there");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(StaticGuardsTest, what_its_initialiser_has_done_comes_before_who_finds_it_there) {
  // By the compiler's look, by the call, or not at all.
  enum class Finds : std::uint8_t { by_look, by_call, not_at_all };
  const auto pass = [](Memory& memory, Finds finds) {
    std::uint64_t guard = 0;
    std::thread writer{[&] { reach(guard, [&] { write(memory.value); }); }};
    std::this_thread::sleep_for(1ms);
    if (finds == Finds::by_look) reach(guard, [] {});
    if (finds == Finds::by_call) static_cast<void>(guard_acquire(&guard));
    read(memory.value);
    writer.join();
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, Finds::by_look); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, Finds::by_call); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, Finds::not_at_all); }).kind, race);
}

TEST_F(StaticGuardsTest, who_has_waited_for_the_initialiser_comes_after_it) {
  EXPECT_EQ(run_alone([](Memory& memory) {
              std::uint64_t guard = 0;
              std::thread writer{[&] {
                reach(guard, [&] {
                  std::this_thread::sleep_for(2ms);
                  write(memory.value);
                });
              }};
              std::this_thread::sleep_for(1ms);
              reach(guard, [] {});
              read(memory.value);
              writer.join();
            }).kind,
            ordered);
}

TEST_F(StaticGuardsTest, a_static_of_a_function_is_initialised_once_and_orders) {
  static Memory* shared = nullptr;
  const auto reach_it = [] {
    static const int value = [] {
      write(shared->value);
      return 1;
    }();
    return value;
  };
  EXPECT_EQ(run_alone([&](Memory& m) {
              shared = &m;
              std::thread writer{reach_it};
              std::this_thread::sleep_for(1ms);
              EXPECT_EQ(reach_it(), 1);
              read(m.value);
              writer.join();
            }).kind,
            ordered);
}

TEST_F(StaticGuardsTest, where_memory_is_weak_who_sees_it_there_sees_what_its_initialiser_stored) {
  const Outcome outcome = run_randomly(500, [](World& world) {
    world.set_memory(ltsim::Memory::c11);
    struct Shared {
      std::uint64_t guard = 0;
      std::atomic<int> value = 0;
    };
    const auto shared = std::make_shared<Shared>();
    for (const char* name : {"one", "two"}) {
      world.process("p").start(name, [shared, &world] {
        reach(shared->guard, [&] { shared->value.store(1, std::memory_order_relaxed); });
        world.require(shared->value.load(std::memory_order_relaxed) == 1, "the value");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(StaticGuardsTest, an_initialiser_that_throws_lets_the_next_one_try) {
  const Outcome outcome = run_randomly(100, [](World& world) {
    struct Shared {
      std::uint64_t guard = 0;
      int tries = 0;
      int failures = 0;
      int finished = 0;
    };
    const auto shared = std::make_shared<Shared>();
    for (const char* name : {"one", "two", "three"}) {
      world.process("p").start(name, [shared, &world] {
        try {
          reach(shared->guard, [&] {
            std::this_thread::yield();
            if (++shared->tries == 1) throw std::runtime_error{"first"};
          });
        } catch (const std::runtime_error&) {
          ++shared->failures;
        }
        if (++shared->finished == 3) world.require(shared->tries == 2 && shared->failures == 1, "one failed");
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(StaticGuardsTest, who_needs_what_he_is_initialising_himself_is_told_at_once) {
  std::uint64_t guard = 0;
  EXPECT_EQ(
      run_task([&](World&) { reach(guard, [&] { reach(guard, [] {}); }); }),
      (Outcome{OutcomeKind::deadlock, "p/main needs a static variable that it is initialising itself"}));
}

TEST_F(StaticGuardsTest, two_initialisers_that_need_each_other_are_a_cycle) {
  const Outcome outcome = run([](World& world) {
    const auto guards = std::make_shared<std::array<std::uint64_t, 2>>();
    for (const std::size_t i : {0U, 1U}) {
      world.process("p").start(i == 0 ? "one" : "two", [guards, i] {
        reach((*guards)[i], [&] {
          std::this_thread::sleep_for(1ms);
          reach((*guards)[1 - i], [] {});
        });
      });
    }
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::deadlock,
                              "a cycle of 2: p/one waits in static_init static-1, at which is p/two; "
                              "p/two waits in static_init static-2, at which is p/one"}));
}

TEST_F(StaticGuardsTest, an_initialiser_that_was_dropped_with_its_execution_begins_anew_in_the_next) {
  std::uint64_t guard = 0;
  int begun = 0;
  for (int i = 1; i <= 2; ++i) {
    EXPECT_EQ(run_task([&](World&) {
                reach(guard, [&] {
                  ++begun;
                  std::abort();
                });
              }).kind,
              OutcomeKind::assertion);
    EXPECT_EQ(begun, i);
  }
  EXPECT_EQ(run_task([&](World&) { reach(guard, [&] { ++begun; }); }), Outcome{});
  reach(guard, [&] { ++begun; });  // outside of any task
  EXPECT_EQ(begun, 3);
}

TEST_F(StaticGuardsTest, outside_of_tasks_it_is_the_real_one) {
  std::uint64_t guard = 0;
  int begun = 0;
  for (int i = 0; i < 2; ++i) reach(guard, [&] { ++begun; });
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(run_task([&](World&) { reach(guard, [&] { ++begun; }); }), Outcome{});
  EXPECT_EQ(begun, 1);
}

TEST_F(StaticGuardsTest, after_its_process_was_killed_in_an_initialiser_the_next_life_waits_for_ever) {
  class KillsAtOnce : public DefaultStrategy {
    [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t) noexcept override {
      return kind == FaultKind::crash && guard_is_taken ? 1 : 0;
    }

   public:
    bool guard_is_taken = false;
  } strategy;
  std::uint64_t guard = 0;
  const Outcome outcome = run_under(strategy, 0, [&](World& world) {
    world.process("p").may_crash({.times = 1, .restart_after = 1ms});
    world.process("p").start("main", [&] {
      reach(guard, [&] {
        strategy.guard_is_taken = true;
        std::this_thread::yield();
      });
    });
  });
  EXPECT_EQ(outcome,
            (Outcome{OutcomeKind::deadlock,
                     "p@2/main waits in static_init static-1, at which is p/main, which was killed"}));
}

}  // namespace
}  // namespace ltsim
