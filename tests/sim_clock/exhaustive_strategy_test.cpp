// The reduction of the exhaustive search against the search without it: both come to the same results of a program.
#include "sim_clock/explore/exhaustive_strategy.hpp"

#include <pthread.h>
#include <semaphore.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_generator.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

/// What the tasks of random programs do.
enum class Step : std::uint8_t {
  load,
  store,
  add,
  compare,
  critical_section,
  two_locks,
  try_lock,
  post,
  wait,
  try_wait,
  timed_wait,
  sleep,
  notify,
  wait_for_notice,
  join_a_thread,
  poll,
  spin,
  read_section,
  write_section,
  try_read,
  timed_write,
  spin_section,
  meet,
  try_to_join,
};
constexpr std::uint32_t steps_count = 24;

bool is_of_semaphore(Step step) noexcept { return step >= Step::post && step <= Step::timed_wait; }

struct TaskPlan {
  std::vector<Step> steps;
  std::vector<std::uint32_t> numbers;  // of each step: which word or lock, how long
};
using Plan = std::vector<TaskPlan>;

Plan random_plan(RandomGenerator& generator) {
  Plan plan(2 + generator.below(2));
  for (TaskPlan& task : plan) {
    const std::uint32_t steps = 1 + generator.below(plan.size() == 2 ? 4 : 2);
    for (std::uint32_t i = 0; i < steps; ++i) {
      task.steps.push_back(static_cast<Step>(generator.below(steps_count)));
      task.numbers.push_back(generator.below(4));
    }
  }
  return plan;
}

std::string to_string(const Plan& plan) {
  std::string text;
  for (const TaskPlan& task : plan) {
    for (std::size_t i = 0; i < task.steps.size(); ++i)
      text += fmt::format("{}.{} ", static_cast<int>(task.steps[i]), task.numbers[i]);
    text += "|| ";
  }
  return text;
}

class ExhaustiveStrategyTest : public WorldTest {
 protected:
  struct Things {
    std::array<std::atomic<std::uint32_t>, 2> words{};
    std::array<std::mutex, 2> mutexes;
    std::condition_variable condition;
    bool notified = false;
    std::shared_timed_mutex rwlock;
    pthread_spinlock_t spin_lock;
    pthread_barrier_t barrier;

    Things() {
      pthread_spin_init(&spin_lock, PTHREAD_PROCESS_PRIVATE);
      pthread_barrier_init(&barrier, nullptr, 2);
    }
  };

  static void run_task(const TaskPlan& plan, Things& things, std::vector<std::uint32_t>& seen) {
    using namespace std::chrono_literals;
    for (std::size_t i = 0; i < plan.steps.size(); ++i) {
      const std::uint32_t number = plan.numbers[i];
      std::atomic<std::uint32_t>& word = things.words[number % 2];
      std::mutex& mutex = things.mutexes[number % 2];
      sem_t* const semaphore =
          is_of_semaphore(plan.steps[i]) ? sem_open(number % 2 == 0 ? "one" : "other", 0) : nullptr;
      switch (plan.steps[i]) {
        case Step::load:
          seen.push_back(word.load());
          break;
        case Step::store:
          word.store(number);
          break;
        case Step::add:
          seen.push_back(word.fetch_add(1));
          break;
        case Step::compare: {
          std::uint32_t found = number / 2;
          word.compare_exchange_strong(found, 3);
          seen.push_back(found);
          break;
        }
        case Step::critical_section: {
          const std::lock_guard lock{mutex};
          seen.push_back(word.load());
          word.store(10 + number);
          break;
        }
        case Step::two_locks: {
          const std::lock_guard one{mutex};
          const std::lock_guard two{things.mutexes[1 - number % 2]};
          seen.push_back(word.fetch_add(5));
          break;
        }
        case Step::try_lock: {
          const std::unique_lock lock{mutex, std::try_to_lock};
          seen.push_back(lock.owns_lock() ? 1 : 0);
          if (lock.owns_lock()) seen.push_back(word.load());
          break;
        }
        case Step::post:
          sem_post(semaphore);
          break;
        case Step::wait:
          sem_wait(semaphore);
          seen.push_back(word.load());
          break;
        case Step::try_wait:
          seen.push_back(sem_trywait(semaphore) == 0 ? 1 : 0);
          break;
        case Step::timed_wait: {
          timespec until{};
          clock_gettime(CLOCK_REALTIME, &until);
          until.tv_sec += 1 + number;
          seen.push_back(sem_timedwait(semaphore, &until) == 0 ? 1 : 0);
          break;
        }
        case Step::sleep:
          std::this_thread::sleep_for(1ms * (1 + number));
          break;
        case Step::notify: {
          {
            const std::lock_guard lock{things.mutexes[0]};
            things.notified = true;
          }
          things.condition.notify_one();
          break;
        }
        case Step::wait_for_notice: {
          std::unique_lock lock{things.mutexes[0]};
          seen.push_back(
              things.condition.wait_for(lock, 1ms * (1 + number), [&] { return things.notified; }) ? 1 : 0);
          break;
        }
        case Step::poll: {
          const auto deadline = std::chrono::steady_clock::now() + 8ms;
          while (word.load() == 0 && std::chrono::steady_clock::now() < deadline)
            std::this_thread::sleep_for(1ms);
          seen.push_back(word.load());
          break;
        }
        case Step::spin:
          for (std::uint32_t tries = 0; word.load() == 0 && tries < 2 + number; ++tries)
            std::this_thread::yield();
          seen.push_back(word.load());
          break;
        case Step::read_section: {
          const std::shared_lock lock{things.rwlock};
          seen.push_back(word.load());
          seen.push_back(things.words[1 - number % 2].load());
          break;
        }
        case Step::write_section: {
          const std::unique_lock lock{things.rwlock};
          things.words[0].store(20 + number);
          things.words[1].store(20 + number);
          break;
        }
        case Step::try_read: {
          const std::shared_lock lock{things.rwlock, std::try_to_lock};
          seen.push_back(lock.owns_lock() ? 1 : 0);
          break;
        }
        case Step::timed_write: {
          const std::unique_lock lock{things.rwlock, 1ms * (1 + number)};
          seen.push_back(lock.owns_lock() ? 1 : 0);
          if (lock.owns_lock() && number % 2 == 0) std::this_thread::sleep_for(2ms);
          break;
        }
        case Step::spin_section:
          if (number % 2 == 0) {
            pthread_spin_lock(&things.spin_lock);
          } else if (pthread_spin_trylock(&things.spin_lock) != 0) {
            seen.push_back(0);
            break;
          }
          seen.push_back(word.fetch_add(3));
          pthread_spin_unlock(&things.spin_lock);
          break;
        case Step::meet:
          seen.push_back(pthread_barrier_wait(&things.barrier) == PTHREAD_BARRIER_SERIAL_THREAD ? 1 : 0);
          break;
        case Step::try_to_join: {
          pthread_t thread{};
          const auto add = [](void* to) -> void* {
            static_cast<std::atomic<std::uint32_t>*>(to)->fetch_add(7);
            return nullptr;
          };
          pthread_create(&thread, nullptr, add, &word);
          const bool joined = pthread_tryjoin_np(thread, nullptr) == 0;
          seen.push_back(joined ? 1 : 0);
          if (!joined) pthread_join(thread, nullptr);
          break;
        }
        case Step::join_a_thread: {
          std::thread thread{[&] { seen.push_back(word.fetch_add(7)); }};
          thread.join();
          break;
        }
      }
    }
  }

  struct Found {
    std::set<std::string> results;
    std::uint64_t executions = 0;
    std::string trouble;
    bool is_over = false;
  };

  static Found search(const Plan& plan, ProofBounds bounds) {
    constexpr std::uint64_t executions_max = 5000;
    Found found;
    const Scenario scenario{
        .name = "test/plan", .description = "", .body = [&](World& of) {
          Things things;
          of.leave_semaphore("one", 0);
          of.leave_semaphore("other", 1);
          std::vector<std::vector<std::uint32_t>> seen(plan.size());
          for (std::size_t i = 0; i < plan.size(); ++i)
            of.process("program").start(fmt::format("task-{}", i),
                                        [&, i] { run_task(plan[i], things, seen[i]); });
          of.run();
          found.results.insert(fmt::format("{} {} {} {}", to_string(of.scheduler().outcome().kind), seen,
                                           things.words[0].load(), things.words[1].load()));
        }};
    Explorer explorer{world()};
    ExhaustiveStrategy strategy{world(), bounds};
    while (!found.is_over && found.executions < executions_max) {
      static_cast<void>(explorer.execute(scenario, strategy, 0, nullptr));
      ++found.executions;
      found.is_over = !strategy.advance();
    }
    found.trouble = strategy.trouble();
    return found;
  }

  void compare(Memory memory, std::uint64_t seed) {
    constexpr unsigned plans_count = 150;
    constexpr unsigned any_number = 1000;
    world().set_default_memory(memory);
    RandomGenerator generator{seed};
    unsigned compared = 0;
    for (unsigned i = 0; i < plans_count; ++i) {
      const Plan plan = random_plan(generator);
      const Found all = search(plan, {.preemptions = any_number, .looks = any_number});
      if (!all.is_over) continue;  // too many orders to try each
      ++compared;
      expect_same(plan, all, search(plan, {.preemptions = {}, .looks = any_number}));
    }
    EXPECT_GT(compared, plans_count / 2);
    world().set_default_memory(Memory::sc);
  }

  static void expect_same(const Plan& plan, const Found& all, const Found& fewer) {
    EXPECT_EQ(fewer.trouble, "") << to_string(plan);
    EXPECT_TRUE(fewer.is_over) << to_string(plan);
    EXPECT_EQ(fmt::format("{}", fmt::join(fewer.results, "\n")),
              fmt::format("{}", fmt::join(all.results, "\n")))
        << to_string(plan);
  }

  /// Every schedule, against one way into each state.
  static void compare_with_states(std::optional<unsigned> silences, std::uint64_t seed) {
    constexpr unsigned plans_count = 150;
    constexpr unsigned any_number = 1000;
    RandomGenerator generator{seed};
    unsigned compared = 0;
    std::uint64_t executions = 0;
    std::uint64_t executions_by_states = 0;
    for (unsigned i = 0; i < plans_count; ++i) {
      const Plan plan = random_plan(generator);
      const Found all = search(plan, {.preemptions = any_number, .silences = silences, .looks = any_number});
      if (!all.is_over) continue;  // too many orders to try each
      const Found by_states = search(plan, {.preemptions = {}, .silences = silences, .states = true});
      ++compared;
      executions += all.executions;
      executions_by_states += by_states.executions;
      expect_same(plan, all, by_states);
      // A bound on preemptions does not go together with sleep sets, but with states it does.
      expect_same(plan, search(plan, {.preemptions = 1, .silences = silences, .looks = any_number}),
                  search(plan, {.preemptions = 1, .silences = silences, .states = true}));
    }
    EXPECT_GT(compared, plans_count / 4);
    EXPECT_LT(3 * executions_by_states, executions);
  }
};

TEST_F(ExhaustiveStrategyTest, comes_to_the_same_results_with_and_without_reduction) {
  compare(Memory::sc, 1);
}

TEST_F(ExhaustiveStrategyTest, comes_to_the_same_results_where_states_are_told_apart) {
  compare_with_states(0, 3);
}

TEST_F(ExhaustiveStrategyTest, comes_to_the_same_results_where_states_are_told_apart_and_time_passes) {
  compare_with_states(std::nullopt, 4);
}

TEST_F(ExhaustiveStrategyTest, comes_to_the_same_results_where_states_are_told_apart_within_one_silence) {
  compare_with_states(1, 6);
}

/// Tasks that hardly remember anything, so that many ways lead to one state.
TEST_F(ExhaustiveStrategyTest, comes_to_the_same_results_where_many_ways_lead_to_one_state) {
  constexpr unsigned programs_count = 100;
  RandomGenerator generator{5};
  std::uint64_t executions = 0;
  std::uint64_t executions_by_states = 0;
  for (unsigned i = 0; i < programs_count; ++i) {
    std::array<std::vector<std::uint32_t>, 3> steps;
    for (auto& of_task : steps) {
      for (std::uint32_t count = 1 + generator.below(3); count != 0; --count)
        of_task.push_back(generator.below(8));
    }
    std::set<std::string> results;
    const Scenario scenario{.name = "test/forgetful", .description = "", .body = [&](World& of) {
                              std::array<std::atomic<std::uint32_t>, 2> words{};
                              for (std::size_t task = 0; task < steps.size(); ++task) {
                                of.process("program").start(fmt::format("task-{}", task), [&, task] {
                                  for (const std::uint32_t step : steps[task]) {
                                    std::atomic<std::uint32_t>& word = words[step % 2];
                                    if (step < 4) {
                                      word.store(step / 2);
                                    } else if (step < 6) {
                                      word.store(words[1 - step % 2].load());
                                    } else {
                                      word.fetch_xor(1);
                                    }
                                  }
                                });
                              }
                              of.run();
                              results.insert(fmt::format("{} {}", words[0].load(), words[1].load()));
                            }};
    const auto search = [&](ProofBounds bounds) {
      results.clear();
      Explorer explorer{world()};
      ExhaustiveStrategy strategy{world(), bounds};
      std::uint64_t count = 1;
      for (; static_cast<void>(explorer.execute(scenario, strategy, 0, nullptr)), strategy.advance();)
        ++count;
      EXPECT_EQ(strategy.trouble(), "");
      return count;
    };
    executions += search({.preemptions = 1000});
    const std::set<std::string> all = results;
    executions_by_states += search({.preemptions = {}, .states = true});
    EXPECT_EQ(results, all) << fmt::format("{}", fmt::join(steps, " || "));
  }
  EXPECT_LT(10 * executions_by_states, executions);
}

TEST_F(ExhaustiveStrategyTest, comes_to_the_same_results_on_weak_memory) { compare(Memory::c11, 2); }

}  // namespace
}  // namespace ltsim
