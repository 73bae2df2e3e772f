// What the world answers to questions that a real machine answers differently each time: random numbers, times of processors, what a
// thread is called and where it may run.

#include <pthread.h>
#include <sched.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/times.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/calls_fixture.hpp"

extern "C" int __register_atfork(void (*prepare)(), void (*parent)(), void (*child)(), void* dso) noexcept;

namespace ltsim {
namespace {

class AnswersTest : public CallsTest {
 protected:
  static std::vector<long> draw_three(long (*draw)()) { return {draw(), draw(), draw()}; }
};

TEST_F(AnswersTest, random_numbers_begin_in_each_execution_as_in_a_program_that_does_not_seed_them) {
  // glibc 2.36: the first numbers of a program that has just begun.
  const std::vector<long> of_rand{1804289383, 846930886, 1681692777};
  const std::vector<long> of_lrand48{0, 2116118, 89401895};
  for (int i = 0; i < 2; ++i) {
    std::vector<long> seen;
    std::vector<long> seen48;
    EXPECT_EQ(run_task([&](World&) {
                seen = draw_three([] { return static_cast<long>(rand()); });
                seen48 = draw_three([] { return lrand48(); });
              }),
              Outcome{});
    EXPECT_EQ(seen, of_rand);
    EXPECT_EQ(seen48, of_lrand48);
  }
}

TEST_F(AnswersTest, a_seed_gives_the_numbers_that_libc_gives_for_it) {
  std::array<char, 64> table{};
  const auto all = [&table] {
    std::vector<long> numbers;
    const auto add = [&](long (*draw)()) {
      for (const long number : draw_three(draw)) numbers.push_back(number);
    };
    srand(42);
    add([] { return static_cast<long>(rand()); });
    srandom(7);
    add([] { return random(); });
    char* const before = initstate(5, table.data(), table.size());
    add([] { return random(); });
    setstate(before);
    add([] { return random(); });
    srand48(3);
    add([] { return lrand48(); });
    add([] { return mrand48(); });
    add([] { return static_cast<long>(drand48() * 1e9); });
    std::array<unsigned short, 3> seed{1, 2, 3};
    numbers.push_back(seed48(seed.data())[0]);
    add([] { return lrand48(); });
    std::array<unsigned short, 7> parameters{1, 2, 3, 4, 5, 6, 7};
    lcong48(parameters.data());
    add([] { return lrand48(); });
    return numbers;
  };
  const std::vector<long> outside = all();
  std::vector<long> inside;
  EXPECT_EQ(run_task([&](World&) { inside = all(); }), Outcome{});
  EXPECT_EQ(inside, outside);
}

TEST_F(AnswersTest, each_process_has_its_own_random_numbers_and_its_threads_share_them) {
  EXPECT_EQ(run([](World& world) {
              for (const char* name : {"a", "b"}) {
                world.process(name).start("main", [&world] {
                  int first = 0;
                  std::thread{[&] { first = rand(); }}.join();
                  world.require(first == 1804289383 && rand() == 846930886, "the first two of its own");
                });
              }
            }),
            Outcome{});
}

TEST_F(AnswersTest, entropy_is_the_same_in_each_execution) {
  std::array<std::vector<std::uint32_t>, 2> seen;
  for (auto& of_execution : seen) {
    EXPECT_EQ(run_task([&](World& world) {
                std::uint32_t number = 0;
                world.require(getentropy(&number, sizeof number) == 0, "entropy");
                of_execution.push_back(number);
                of_execution.push_back(arc4random());
                arc4random_buf(&number, sizeof number);
                of_execution.push_back(number);
                of_execution.push_back(arc4random_uniform(10));
                world.require(of_execution.back() < 10, "below its bound");
                std::array<char, 257> much{};
                world.require(getentropy(much.data(), much.size()) == -1 && errno == EIO, "too much");
              }),
              Outcome{});
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_NE(seen[0][0], seen[0][1]);
}

TEST_F(AnswersTest, a_process_has_used_processors_as_long_as_the_world_has_lasted) {
  EXPECT_EQ(run_task([](World& world) {
              std::this_thread::sleep_for(1250ms);
              world.require(clock() / (CLOCKS_PER_SEC / 1000) == 1250, "clock");
              tms of{};
              world.require(times(&of) == 125 && of.tms_utime == 125 && of.tms_stime == 0, "times");
              rusage usage{};
              world.require(getrusage(RUSAGE_SELF, &usage) == 0 && usage.ru_utime.tv_sec == 1, "getrusage");
              world.require(usage.ru_utime.tv_usec / 1000 == 250, "getrusage");
              clockid_t clock_id{};
              timespec time{};
              world.require(pthread_getcpuclockid(pthread_self(), &clock_id) == 0, "clock of a thread");
              world.require(clock_gettime(clock_id, &time) == 0 && time.tv_sec == 1, "its time");
            }),
            Outcome{});
}

TEST_F(AnswersTest, a_thread_has_the_name_that_it_was_given_for_one_execution) {
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(
        run_task([](World& world) {
          std::array<char, 16> name{};
          const auto name_of = [&](pthread_t thread) {
            pthread_getname_np(thread, name.data(), name.size());
            return std::string{name.data()};
          };
          world.require(name_of(pthread_self()) == "p", "that of its process");
          world.require(pthread_setname_np(pthread_self(), "mine") == 0, "given");
          world.require(name_of(pthread_self()) == "mine", "told");
          std::thread other{[] { std::this_thread::sleep_for(1ms); }};
          world.require(name_of(other.native_handle()) == "mine", "as with Linux, that of who made it");
          world.require(pthread_setname_np(other.native_handle(), "0123456789abcdef") == ERANGE, "too long");
          world.require(pthread_setname_np(other.native_handle(), "0123456789abcde") == 0, "not too long");
          world.require(name_of(other.native_handle()) == "0123456789abcde", "its own");
          world.require(pthread_getname_np(pthread_self(), name.data(), 4) == ERANGE, "no room");
          other.join();
        }),
        Outcome{});
  }
}

TEST_F(AnswersTest, a_thread_may_run_on_two_processors_or_on_those_that_it_was_told) {
  EXPECT_EQ(run_task([](World& world) {
              cpu_set_t set;
              world.require(sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) == 2, "two");
              world.require(sched_getcpu() == 0, "the first");
              CPU_ZERO(&set);
              CPU_SET(1, &set);
              world.require(pthread_setaffinity_np(pthread_self(), sizeof set, &set) == 0, "told");
              world.require(sched_getcpu() == 1, "there");
              CPU_ZERO(&set);
              CPU_SET(5, &set);
              world.require(sched_setaffinity(0, sizeof set, &set) == -1 && errno == EINVAL,
                            "no such processor");
              world.require(sched_setaffinity(1, sizeof set, &set) == -1 && errno == ESRCH, "no such thread");
              std::thread{[&] {
                pthread_getaffinity_np(pthread_self(), sizeof set, &set);
                world.require(CPU_COUNT(&set) == 1 && CPU_ISSET(1, &set), "those of who made it");
              }}.join();
            }),
            Outcome{});
}

TEST_F(AnswersTest, a_thread_knows_its_stack) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_attr_t attributes;
              world.require(pthread_getattr_np(pthread_self(), &attributes) == 0, "attributes");
              void* stack = nullptr;
              std::size_t bytes = 0;
              pthread_attr_getstack(&attributes, &stack, &bytes);
              const int here = 0;
              world.require(
                  &here >= stack && reinterpret_cast<const char*>(&here) < static_cast<char*>(stack) + bytes,
                  "here");
              pthread_attr_destroy(&attributes);
            }),
            Outcome{});
}

bool handler_ran = false;

TEST_F(AnswersTest, handlers_of_forking_are_for_nobody) {
  EXPECT_EQ(run_task([](World& world) {
              world.require(__register_atfork([] { handler_ran = true; }, nullptr, nullptr, nullptr) == 0,
                            "accepted");
            }),
            Outcome{});
  if (fork() == 0) _exit(0);
  EXPECT_FALSE(handler_ran);
}

}  // namespace
}  // namespace ltsim
