// How threads end and what they leave: pthread_exit, values by keys, joining for a while or not at all.

#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/races_fixture.hpp"

// <pthread.h> declares them where there are no exceptions.
extern "C" void __pthread_register_cancel(__pthread_unwind_buf_t* buffer) noexcept;
extern "C" void __pthread_unregister_cancel(__pthread_unwind_buf_t* buffer) noexcept;
extern "C" [[noreturn]] void __pthread_unwind_next(__pthread_unwind_buf_t* buffer);

namespace ltsim {
namespace {

class ThreadEndsTest : public RacesTest {
 protected:
  static inline std::vector<std::string> order;
  void SetUp() override { order.clear(); }

  struct Traced {
    const char* name;
    ~Traced() { order.emplace_back(name); }
  };

  template <typename Body>
  static pthread_t start(const Body& body) {
    pthread_t thread{};
    auto* const copy = new Body{body};
    pthread_create(
        &thread, nullptr,
        [](void* of) -> void* {
          const std::unique_ptr<Body> mine{static_cast<Body*>(of)};
          return (*mine)();
        },
        copy);
    return thread;
  }

  static void* number(std::intptr_t value) { return reinterpret_cast<void*>(value); }
  static void* null() { return nullptr; }
};

// --- pthread_exit ---

TEST_F(ThreadEndsTest, pthread_exit_runs_the_destructors_of_the_frames_then_of_thread_locals_then_of_keys) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_key_t key{};
              pthread_key_create(&key,
                                 [](void* value) { order.emplace_back(static_cast<const char*>(value)); });
              const pthread_t thread = start([&]() -> void* {
                thread_local const Traced of_thread{"thread-local"};
                const Traced outer{"outer"};
                order.emplace_back(of_thread.name == nullptr ? "" : "begins");
                pthread_setspecific(key, "key");
                [] {
                  const Traced inner{"inner"};
                  pthread_exit(number(7));
                }();
                order.emplace_back("went on");
                return nullptr;
              });
              void* result = nullptr;
              world.require(pthread_join(thread, &result) == 0 && result == number(7), "its result");
            }),
            Outcome{});
  EXPECT_EQ(order, (std::vector<std::string>{"begins", "inner", "outer", "thread-local", "key"}));
}

TEST_F(ThreadEndsTest, pthread_exit_ends_a_thread_of_the_standard_library_and_the_first_task) {
  EXPECT_EQ(run_task([](World&) {
              const Traced first{"first"};
              std::thread{[] {
                const Traced second{"second"};
                pthread_exit(nullptr);
              }}.join();
              pthread_exit(nullptr);
            }),
            Outcome{});
  EXPECT_EQ(order, (std::vector<std::string>{"second", "first"}));
}

TEST_F(ThreadEndsTest, pthread_exit_passes_catch_all_that_throws_on_and_wakes_who_joins) {
  EXPECT_EQ(run_task([](World& world) {
              const pthread_t thread = start([]() -> void* {
                std::this_thread::sleep_for(1ms);
                try {
                  pthread_exit(number(3));
                } catch (...) {
                  order.emplace_back("caught");
                  throw;
                }
              });
              void* result = nullptr;
              world.require(pthread_join(thread, &result) == 0 && result == number(3), "its result");
              world.require(world.now() >= 1ms, "when it has ended");
            }),
            Outcome{});
  EXPECT_EQ(order, (std::vector<std::string>{"caught"}));
}

TEST_F(ThreadEndsTest,
       pthread_exit_that_is_caught_for_good_is_an_assertion) {  // glibc: "exception not rethrown"
  EXPECT_EQ(
      run_task([](World&) {
        try {
          pthread_exit(nullptr);
        } catch (...) {
        }
      }),
      (Outcome{
          OutcomeKind::assertion,
          "p/main: what pthread_exit() throws was caught by \"catch (...)\", which has to throw it on"}));
  // By gcc std::terminate() has no exception to tell of, by clang it has one of an unknown type.
  const OutcomeKind kind = run_task([](World&) { []() noexcept { pthread_exit(nullptr); }(); }).kind;
  EXPECT_TRUE(kind == OutcomeKind::assertion || kind == OutcomeKind::crash) << to_string(kind);
}

TEST_F(ThreadEndsTest, pthread_exit_in_a_destructor_that_runs_at_the_end_is_refused) {
  EXPECT_EQ(
      run_task([](World&) {
        pthread_key_t key{};
        pthread_key_create(&key, [](void*) { pthread_exit(nullptr); });
        pthread_setspecific(key, "value");
      }),
      (Outcome{
          OutcomeKind::unsupported,
          "p/main called pthread_exit in a destructor that runs at its end, which ltsim does not simulate"}));
}

TEST_F(ThreadEndsTest, exceptions_are_what_they_were_after_a_thread_has_exited) {
  EXPECT_EQ(run_task([](World& world) {
              try {
                throw 1;
              } catch (int) {
                std::thread{[] {
                  try {
                    throw 2;
                  } catch (int) {
                    pthread_exit(nullptr);
                  }
                }}.join();
                try {
                  throw;
                } catch (int number) {
                  world.require(number == 1, "its own");
                }
              }
            }),
            Outcome{});
}

/// As pthread_cleanup_push() is in C, where there are no destructors.
TEST_F(ThreadEndsTest, handlers_of_c_run_from_the_innermost_on) {
  EXPECT_EQ(run_task([](World& world) {
              const pthread_t thread = start([]() -> void* {
                __pthread_unwind_buf_t outer;
                if (__sigsetjmp_cancel(outer.__cancel_jmp_buf, 0) != 0) {
                  order.emplace_back("outer");
                  __pthread_unwind_next(&outer);
                }
                __pthread_register_cancel(&outer);
                []() -> void {
                  __pthread_unwind_buf_t gone;
                  __pthread_register_cancel(&gone);
                  __pthread_unregister_cancel(&gone);
                  __pthread_unwind_buf_t inner;
                  if (__sigsetjmp_cancel(inner.__cancel_jmp_buf, 0) != 0) {
                    order.emplace_back("inner");
                    __pthread_unwind_next(&inner);
                  }
                  __pthread_register_cancel(&inner);
                  pthread_exit(number(5));
                }();
                return nullptr;
              });
              void* result = nullptr;
              world.require(pthread_join(thread, &result) == 0 && result == number(5), "its result");
            }),
            Outcome{});
  EXPECT_EQ(order, (std::vector<std::string>{"inner", "outer"}));
}

TEST_F(ThreadEndsTest, cancellation_is_refused_and_what_belongs_to_it_does_nothing) {
  const Outcome outcome = run_task([](World& world) {
    int old = -1;
    world.require(pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &old) == 0 && old == PTHREAD_CANCEL_ENABLE,
                  "first");
    world.require(pthread_setcancelstate(PTHREAD_CANCEL_ENABLE, &old) == 0 && old == PTHREAD_CANCEL_DISABLE,
                  "then");
    world.require(
        pthread_setcanceltype(PTHREAD_CANCEL_ASYNCHRONOUS, &old) == 0 && old == PTHREAD_CANCEL_DEFERRED,
        "type");
    world.require(pthread_setcancelstate(7, nullptr) == EINVAL, "no state");
    pthread_testcancel();
    pthread_cancel(pthread_self());
  });
  EXPECT_EQ(outcome,
            (Outcome{OutcomeKind::unsupported,
                     "p/main called pthread_cancel, which ltsim does not simulate: let the thread look "
                     "at a flag, and return"}));
}

// --- keys ---

TEST_F(ThreadEndsTest, each_thread_has_its_own_value_and_none_at_first) {
  for (int i = 0; i < 2; ++i) {  // nor in the next execution
    EXPECT_EQ(run_task([](World& world) {
                pthread_key_t key{};
                pthread_key_t other{};
                world.require(pthread_key_create(&key, nullptr) == 0, "made");
                world.require(pthread_key_create(&other, nullptr) == 0 && other != key, "another");
                world.require(pthread_getspecific(key) == nullptr, "none");
                world.require(pthread_setspecific(key, number(1)) == 0, "set");
                std::thread{[&] {
                  world.require(pthread_getspecific(key) == nullptr, "none there");
                  pthread_setspecific(key, number(2));
                }}.join();
                world.require(pthread_getspecific(key) == number(1), "its own");
                world.require(pthread_getspecific(other) == nullptr, "none of the other key");
                world.require(pthread_key_delete(key) == 0, "gone");
                world.require(pthread_key_delete(key) == EINVAL, "once");
                world.require(pthread_setspecific(key, number(1)) == EINVAL, "no key");
                world.require(pthread_getspecific(key) == nullptr, "no key has no value");
                world.require(pthread_key_create(&key, nullptr) == 0, "made again");
                world.require(pthread_getspecific(key) == nullptr, "and its value is none again");
              }),
              Outcome{});
  }
}

pthread_key_t stubborn{};
int destructions = 0;

TEST_F(ThreadEndsTest,
       destructors_run_again_while_they_set_values_and_not_for_ever) {  // PTHREAD_DESTRUCTOR_ITERATIONS
  destructions = 0;
  EXPECT_EQ(run_task([](World& world) {
              pthread_key_t first{};
              pthread_key_create(&first,
                                 [](void* value) { order.emplace_back(static_cast<const char*>(value)); });
              pthread_key_create(&stubborn, [](void* value) {
                ++destructions;
                pthread_setspecific(stubborn, value);
              });
              pthread_key_t deleted{};
              pthread_key_create(&deleted, [](void*) { order.emplace_back("deleted"); });
              std::thread{[&] {
                pthread_setspecific(deleted, "value");
                pthread_setspecific(stubborn, "value");
                pthread_setspecific(first, "first");
                pthread_key_delete(deleted);
              }}.join();
              world.require(destructions == 4, "four times");
            }),
            Outcome{});
  EXPECT_EQ(order, (std::vector<std::string>{"first"}));
}

pthread_key_t made_once{};
pthread_once_t once = PTHREAD_ONCE_INIT;

TEST_F(ThreadEndsTest, a_key_that_only_the_first_execution_makes_is_there_in_the_later_ones) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(run_task([](World& world) {
                pthread_key_t of_each_execution{};
                pthread_key_create(&of_each_execution, nullptr);
                pthread_once(&once, [] {
                  pthread_key_create(
                      &made_once, [](void* value) { order.emplace_back(static_cast<const char*>(value)); });
                });
                world.require(of_each_execution != made_once, "two keys");
                std::thread{[&] {
                  world.require(pthread_getspecific(made_once) == nullptr, "no value");
                  world.require(pthread_setspecific(made_once, "destroyed") == 0, "a key");
                  world.require(pthread_getspecific(of_each_execution) == nullptr, "no value of the other");
                }}.join();
              }),
              Outcome{});
    EXPECT_EQ(order.size(), static_cast<std::size_t>(i) + 1);
  }
}

TEST_F(ThreadEndsTest, a_key_that_is_used_and_was_not_made_is_not_given_to_somebody_else) {
  pthread_key_t copied{};
  for (const bool is_first : {true, false, false}) {
    EXPECT_EQ(run_task([&](World& world) {
                pthread_key_t local{};
                if (is_first) {
                  pthread_key_create(&local, nullptr);
                  copied = local;
                }
                world.require(pthread_setspecific(copied, "value") == 0, "a key");
                pthread_key_create(&local, nullptr);
                world.require(local != copied && pthread_getspecific(local) == nullptr, "another one");
              }),
              Outcome{});
  }
}

TEST_F(ThreadEndsTest, a_key_made_outside_of_tasks_has_values_there_and_in_each_task) {
  pthread_key_t key{};
  ASSERT_EQ(
      pthread_key_create(&key, [](void* value) { order.emplace_back(static_cast<const char*>(value)); }), 0);
  pthread_setspecific(key, "outside");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run_task([key](World& world) {
                world.require(pthread_getspecific(key) == nullptr, "none in a task");
                pthread_setspecific(key, "inside");
                world.require(pthread_getspecific(key) != nullptr, "one in it");
              }),
              Outcome{});
  }
  EXPECT_STREQ(static_cast<const char*>(pthread_getspecific(key)), "outside");
  EXPECT_EQ(order, (std::vector<std::string>{"inside", "inside"}));
  pthread_key_delete(key);
}

TEST_F(ThreadEndsTest, processes_have_keys_of_their_own_and_a_key_of_the_program_in_common) {
  static pthread_key_t of_program{};
  EXPECT_EQ(run([](World& world) {
              for (const char* name : {"a", "b"}) {
                world.process(name).start("main", [&world, name] {
                  pthread_key_create(&of_program, nullptr);  // both, into the same variable
                  pthread_setspecific(of_program, name);
                  std::this_thread::sleep_for(1ms);
                  world.require(pthread_getspecific(of_program) == name, "its own value");
                  if (*name == 'a') pthread_key_delete(of_program);
                  std::this_thread::sleep_for(1ms);
                  world.require((pthread_getspecific(of_program) == name) == (*name == 'b'), "its own key");
                });
              }
            }),
            Outcome{});
}

// --- joining ---

TEST_F(ThreadEndsTest, a_thread_that_runs_is_not_joined_by_a_try_or_within_a_time) {
  EXPECT_EQ(run_task([](World& world) {
              const pthread_t thread = start([]() -> void* {
                std::this_thread::sleep_for(10ms);
                return number(4);
              });
              world.require(pthread_tryjoin_np(thread, nullptr) == EBUSY, "it runs");
              SimTime begin = world.now();
              timespec deadline = in(2ms, CLOCK_REALTIME);
              world.require(pthread_timedjoin_np(thread, nullptr, &deadline) == ETIMEDOUT, "still");
              world.require(took(world, begin, 2ms), "at its time");
              begin = world.now();
              deadline = in(2ms, CLOCK_MONOTONIC);
              world.require(pthread_clockjoin_np(thread, nullptr, CLOCK_MONOTONIC, &deadline) == ETIMEDOUT,
                            "still");
              world.require(took(world, begin, 2ms), "at its time");
              deadline.tv_nsec = 1'000'000'000;
              world.require(pthread_timedjoin_np(thread, nullptr, &deadline) == EINVAL, "no time");
              world.require(pthread_clockjoin_np(thread, nullptr, CLOCK_TAI, &deadline) == EINVAL,
                            "no clock for it");
              deadline = in(20ms, CLOCK_REALTIME);
              void* result = nullptr;
              world.require(pthread_timedjoin_np(thread, &result, &deadline) == 0, "it has ended");
              world.require(result == number(4) && world.now() < 11ms, "then");
              world.require(pthread_tryjoin_np(thread, nullptr) == ESRCH, "joined once");
              const pthread_t other = start([] { return null(); });
              std::this_thread::sleep_for(1ms);
              world.require(pthread_tryjoin_np(other, nullptr) == 0, "ended");
            }),
            Outcome{});
}

TEST_F(ThreadEndsTest, a_thread_that_was_joined_by_a_try_comes_before_who_joined_it) {
  const auto pass = [](Memory& memory, bool joins) {
    const pthread_t thread = start([&] {
      write(memory.value);
      return null();
    });
    std::this_thread::sleep_for(1ms);
    if (joins) pthread_tryjoin_np(thread, nullptr);
    write(memory.value);
    if (!joins) pthread_join(thread, nullptr);
  };
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, true); }).kind, ordered);
  EXPECT_EQ(run_alone([&](Memory& m) { pass(m, false); }).kind, race);
}

TEST_F(ThreadEndsTest, who_tries_to_join_again_and_again_gives_way) {
  EXPECT_EQ(run_task([](World& world) {
              const pthread_t thread = start([] {
                sched_yield();
                return null();
              });
              while (pthread_tryjoin_np(thread, nullptr) == EBUSY) {
              }
              world.require(world.now() < 1ms, "before long");
            }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
