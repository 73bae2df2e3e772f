// <threads.h> of C11, which are the world's threads, mutexes, conditions and keys by other names.

#include <threads.h>

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

class C11ThreadsTest : public RacesTest {};

TEST_F(C11ThreadsTest, a_thread_has_a_number_for_its_result) {
  EXPECT_EQ(run_task([](World& world) {
              thrd_t thread{};
              world.require(thrd_create(
                                &thread, [](void* of) { return *static_cast<int*>(of); },
                                std::make_unique<int>(-5).release()) == thrd_success,
                            "created");
              int result = 0;
              world.require(thrd_join(thread, &result) == thrd_success && result == -5, "its result");
              world.require(thrd_join(thread, nullptr) == thrd_error, "joined once");
              thrd_create(&thread, [](void*) -> int { thrd_exit(9); }, nullptr);
              world.require(thrd_join(thread, &result) == thrd_success && result == 9, "that of thrd_exit()");
              thrd_create(&thread, [](void*) { return 0; }, nullptr);
              world.require(thrd_detach(thread) == thrd_success, "detached");
              world.require(thrd_join(thread, nullptr) == thrd_error, "and not joined");
              world.require(thrd_equal(thrd_current(), thrd_current()) != 0, "itself");
            }),
            Outcome{});
}

TEST_F(C11ThreadsTest, a_thread_sleeps_as_long_as_it_was_told_and_yields) {
  EXPECT_EQ(run_task([](World& world) {
              const timespec duration{.tv_sec = 0, .tv_nsec = 2'000'000};
              world.require(thrd_sleep(&duration, nullptr) == 0 && took(world, 0ms, 2ms), "so long");
              const timespec none{.tv_sec = 0, .tv_nsec = -1};
              world.require(thrd_sleep(&none, nullptr) < -1, "no time");
              std::atomic<bool> done = false;
              thrd_t thread{};
              thrd_create(
                  &thread,
                  [](void* of) {
                    *static_cast<std::atomic<bool>*>(of) = true;
                    return 0;
                  },
                  &done);
              while (!done) thrd_yield();
              world.require(world.now() < 3ms, "it could run at once");
              thrd_join(thread, nullptr);
            }),
            Outcome{});
}

TEST_F(C11ThreadsTest, a_sleep_that_is_interrupted_says_so) {
  class Interrupts : public DefaultStrategy {
    [[nodiscard]] std::size_t strike(FaultKind, std::size_t) noexcept override { return 2; }
  } strategy;
  EXPECT_EQ(run_under(strategy, 0,
                      [](World& world) {
                        world.grant(FaultKind::interrupt, 1);
                        world.process("p").start("main", [&world] {
                          const timespec duration{.tv_sec = 0, .tv_nsec = 2'000'000};
                          timespec left{};
                          world.require(thrd_sleep(&duration, &left) == -1, "interrupted");
                          world.require(
                              left.tv_sec == 0 && left.tv_nsec > 999'000 && left.tv_nsec <= 1'000'000,
                              "half-way");
                        });
                      }),
            Outcome{});
}

TEST_F(C11ThreadsTest, mutexes_follow_their_types) {
  EXPECT_EQ(run_task([](World& world) {
              mtx_t plain;
              mtx_t recursive;
              world.require(mtx_init(&plain, mtx_timed) == thrd_success, "made");
              mtx_init(&recursive, mtx_plain | mtx_recursive);
              world.require(mtx_lock(&plain) == thrd_success, "free");
              world.require(mtx_trylock(&plain) == thrd_busy, "held");
              const timespec deadline = in(2ms, CLOCK_REALTIME);
              const SimTime begin = world.now();
              world.require(mtx_timedlock(&plain, &deadline) == thrd_timedout && took(world, begin, 2ms),
                            "in time");
              world.require(mtx_unlock(&plain) == thrd_success, "given back");
              world.require(mtx_lock(&recursive) == thrd_success, "once");
              world.require(mtx_trylock(&recursive) == thrd_success, "and again");
              mtx_unlock(&recursive);
              mtx_unlock(&recursive);
              mtx_destroy(&plain);
              mtx_destroy(&recursive);
            }),
            Outcome{});
  EXPECT_EQ(
      run_task([](World&) {
        mtx_t mutex;
        mtx_init(&mutex, mtx_plain);
        mtx_lock(&mutex);
        mtx_lock(&mutex);
      }),
      (Outcome{OutcomeKind::deadlock, "a cycle of 1: p/main waits in mutex_lock mutex-1, held by p/main"}));
}

struct Shared {
  mtx_t mutex{};
  cnd_t condition{};
  int woken = 0;
  int* value = nullptr;
};

TEST_F(C11ThreadsTest, conditions_wake_one_or_all_and_time_out) {
  EXPECT_EQ(run_task([](World& world) {
              Shared shared;
              mtx_init(&shared.mutex, mtx_plain);
              cnd_init(&shared.condition);
              const auto wait = [](void* of) {
                auto& with = *static_cast<Shared*>(of);
                mtx_lock(&with.mutex);
                for (int i = 0; i < 2; ++i) {
                  if (cnd_wait(&with.condition, &with.mutex) != thrd_success) return 1;
                  ++with.woken;
                }
                mtx_unlock(&with.mutex);
                return 0;
              };
              std::array<thrd_t, 2> threads{};
              for (thrd_t& thread : threads) thrd_create(&thread, wait, &shared);
              const timespec millisecond{.tv_sec = 0, .tv_nsec = 1'000'000};
              thrd_sleep(&millisecond, nullptr);
              for (const int expected : {1, 2}) {
                cnd_signal(&shared.condition);
                thrd_sleep(&millisecond, nullptr);
                world.require(shared.woken == expected, "one");
              }
              cnd_broadcast(&shared.condition);
              thrd_sleep(&millisecond, nullptr);
              world.require(shared.woken == 4, "both");
              for (const thrd_t& thread : threads) thrd_join(thread, nullptr);
              mtx_lock(&shared.mutex);
              const timespec deadline = in(2ms, CLOCK_REALTIME);
              const SimTime begin = world.now();
              world.require(cnd_timedwait(&shared.condition, &shared.mutex, &deadline) == thrd_timedout,
                            "nobody");
              world.require(took(world, begin, 2ms), "at its time");
              mtx_unlock(&shared.mutex);
              cnd_destroy(&shared.condition);
              mtx_destroy(&shared.mutex);
            }),
            Outcome{});
}

TEST_F(C11ThreadsTest, a_mutex_orders_and_so_does_joining) {
  const auto pass = [](Memory& memory, bool locks) {
    Shared shared;
    mtx_init(&shared.mutex, mtx_plain);
    shared.value = &memory.value;
    thrd_t thread{};
    thrd_create(
        &thread,
        [](void* of) {
          auto& with = *static_cast<Shared*>(of);
          mtx_lock(&with.mutex);
          write(*with.value);
          mtx_unlock(&with.mutex);
          return 0;
        },
        &shared);
    const timespec millisecond{.tv_sec = 0, .tv_nsec = 1'000'000};
    thrd_sleep(&millisecond, nullptr);
    if (locks) mtx_lock(&shared.mutex);
    write(memory.value);
    if (locks) mtx_unlock(&shared.mutex);
    thrd_join(thread, nullptr);
    write(memory.value);
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, true); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, false); }).kind, race);
}

int calls = 0;

TEST_F(C11ThreadsTest, once_is_once_and_keys_are_keys) {
  calls = 0;
  once_flag flag = ONCE_FLAG_INIT;
  EXPECT_EQ(run_task([&flag](World& world) {
              for (int i = 0; i < 2; ++i) call_once(&flag, [] { ++calls; });
              world.require(calls == 1, "once");
              tss_t key{};
              world.require(
                  tss_create(&key, [](void* value) { calls += *static_cast<int*>(value); }) == thrd_success,
                  "made");
              world.require(tss_get(key) == nullptr, "no value");
              thrd_t thread{};
              thrd_create(
                  &thread,
                  [](void* of) {
                    static int ten = 10;
                    return tss_set(*static_cast<tss_t*>(of), &ten) == thrd_success &&
                                   tss_get(*static_cast<tss_t*>(of)) == &ten
                               ? 0
                               : 1;
                  },
                  &key);
              int result = 1;
              thrd_join(thread, &result);
              world.require(result == 0 && calls == 11, "destroyed at the end of the thread");
              tss_delete(key);
              world.require(tss_set(key, &calls) == thrd_error, "no key any more");
            }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
