// Every strategy: each choice that there is can be made, and an execution written down is the same when it is replayed.

#include <fcntl.h>
#include <semaphore.h>

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "property_tests/sim_clock/small_program.hpp"
#include "property_tests/support/property.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/strategies.hpp"

namespace property_tests {
namespace {

using namespace ltsim;
using namespace std::chrono_literals;

/// Explores a scenario until it has ended in as many ways as there are, or for 30,000 executions.
/// @param seen  the ways, each execution adds its own
/// @return      whether all were seen
bool sees_all(const Scenario& scenario, const std::string& strategy_name, const std::set<std::string>& seen,
              std::size_t possible) {
  constexpr std::uint64_t explorations_max = 100;
  const auto strategy = make_strategy(strategy_name);
  ExploreOptions options;
  options.executions_max = 300;
  for (options.seed = 1; options.seed <= explorations_max && seen.size() < possible; ++options.seed)
    static_cast<void>(Explorer{world()}.explore(scenario, *strategy, options));
  RC_LOG() << seen.size() << " of " << possible << " seen\n";
  return seen.size() == possible;
}

/// (a + b + ...)! / (a! b! ...)
std::size_t interleavings(const std::vector<int>& steps) {
  std::size_t count = 1;
  std::size_t total = 0;
  for (const int of_task : steps) {
    for (int i = 1; i <= of_task; ++i) count = count * ++total / static_cast<std::size_t>(i);
  }
  return count;
}

PROPERTY(Strategies, reach_every_interleaving_of_a_small_program, ()) {
  const auto steps = *rc::gen::suchThat(
      rc::gen::mapcat(rc::gen::inRange<std::size_t>(2, 4),
                      [](std::size_t tasks) {
                        return rc::gen::container<std::vector<int>>(tasks, rc::gen::inRange(1, 4));
                      }),
      [](const std::vector<int>& of_tasks) { return interleavings(of_tasks) <= 20; });
  const std::string name = *rc::gen::elementOf(strategy_names());
  // A limit of pct that its header tells: who has not begun does not fall below who has.
  RC_PRE(name != "pct" || steps.size() == 2);
  std::set<std::string> orders;
  std::string order;
  const Scenario scenario{"property/interleavings", "", [&](World& of_run) {
                            order.clear();
                            const auto word = std::make_shared<std::atomic<int>>(0);
                            for (std::size_t task = 0; task < steps.size(); ++task) {
                              of_run.process("p").start(std::to_string(task), [&order, &steps, word, task] {
                                for (int i = 0; i < steps[task]; ++i) {
                                  *word = i;
                                  order += static_cast<char>('0' + task);
                                }
                              });
                            }
                            of_run.run();
                            orders.insert(order);
                          }};
  RC_ASSERT(sees_all(scenario, name, orders, interleavings(steps)));
}

/// Makes the choices of another, and counts which of the tasks that could run it takes.
class CountingStrategy final : public Strategy {
 public:
  static constexpr std::size_t options_max = 4;
  using Counts =
      std::array<std::array<unsigned, options_max>, options_max + 1>;  // by how many could run, by index

  explicit CountingStrategy(Strategy& chooser) : chooser_{chooser} {}

  [[nodiscard]] std::string_view name() const noexcept override { return chooser_.name(); }
  void begin_execution(std::uint64_t seed) noexcept override { chooser_.begin_execution(seed); }
  void learn(const ExecutionSummary& summary) noexcept override { chooser_.learn(summary); }
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override {
    const std::size_t chosen = chooser_.choose_task(choice);
    ++taken_[choice.options.size()][chosen];
    return chosen;
  }
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override {
    return chooser_.slow_moment(choice);
  }
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override {
    return chooser_.strike(kind, variants_count);
  }
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override { return chooser_.answer(count); }
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override {
    return chooser_.choose_age(choice);
  }
  [[nodiscard]] bool follows_steps() const noexcept override { return chooser_.follows_steps(); }
  void performs(TaskId task, const Operation& operation) noexcept override {
    chooser_.performs(task, operation);
  }

  [[nodiscard]] const Counts& taken() const noexcept { return taken_; }

 private:
  Strategy& chooser_;
  Counts taken_{};
};

// By itself: what one kind of decision leaves out, a slow moment at the right place can make up for.
PROPERTY(Strategies, take_any_of_the_tasks_that_can_run, ()) {
  const auto tasks = *rc::gen::inRange<std::size_t>(2, CountingStrategy::options_max + 1);
  const auto steps = *rc::gen::inRange(2, 5);
  const std::string name = *rc::gen::elementOf(strategy_names());
  const Scenario scenario{"property/take-any", "", [&](World& of_run) {
                            const auto word = std::make_shared<std::atomic<int>>(0);
                            for (std::size_t task = 0; task < tasks; ++task) {
                              of_run.process("p").start(std::to_string(task), [steps, word] {
                                for (int i = 0; i < steps; ++i) word->fetch_add(i);
                              });
                            }
                            of_run.run();
                          }};
  const auto strategy = make_strategy(name);
  CountingStrategy counting{*strategy};
  ExploreOptions options;
  options.executions_max = 3'000;
  static_cast<void>(Explorer{world()}.explore(scenario, counting, options));
  for (std::size_t count = 2; count <= tasks; ++count) {
    for (std::size_t index = 0; index < count; ++index) {
      RC_LOG() << counting.taken()[count][index] << " times number " << index << " of " << count << '\n';
      RC_ASSERT(counting.taken()[count][index] > 0);
    }
  }
}

PROPERTY(Strategies, give_every_answer, ()) {
  const auto answers = *rc::gen::inRange<std::size_t>(2, 12);
  const std::string name = *rc::gen::elementOf(strategy_names());
  std::set<std::string> given;
  const Scenario scenario{"property/answers", "", [&](World& of_run) {
                            given.insert(std::to_string(of_run.choose("answer", answers)));
                            of_run.run();
                          }};
  RC_ASSERT(sees_all(scenario, name, given, answers));
}

PROPERTY(Strategies, let_a_fault_strike_at_each_place_and_at_none, ()) {
  const auto posts = *rc::gen::inRange<std::size_t>(1, 5);
  const std::string name = *rc::gen::elementOf(strategy_names());
  std::set<std::string> all_lost;
  std::string lost;
  const Scenario scenario{"property/faults", "", [&](World& of_run) {
                            lost = "none";
                            of_run.grant(FaultKind::lost_post, 1);
                            of_run.process("p").start("main", [&lost, posts] {
                              sem_t* const bell = sem_open("/bell", O_CREAT, 0600, 0);
                              for (std::size_t i = 0; i < posts; ++i) {
                                sem_post(bell);
                                if (sem_trywait(bell) != 0) lost = std::to_string(i);
                              }
                            });
                            of_run.run();
                            all_lost.insert(lost);
                          }};
  RC_ASSERT(sees_all(scenario, name, all_lost, posts + 1));
}

PROPERTY(Strategies, let_a_time_out_fire_before_and_after_what_it_waits_for, ()) {
  const std::chrono::milliseconds limit{*rc::gen::inRange(1, 50)};
  const std::string name = *rc::gen::elementOf(strategy_names());
  std::set<std::string> seen;
  const Scenario scenario{"property/time-out", "", [&](World& of_run) {
                            const auto done = std::make_shared<std::atomic<bool>>(false);
                            of_run.process("p").start("worker", [done] { *done = true; });
                            of_run.process("p").start("waiter", [&seen, done, limit] {
                              std::this_thread::sleep_for(limit);
                              seen.insert(*done ? "done" : "late");
                            });
                            of_run.run();
                          }};
  RC_ASSERT(sees_all(scenario, name, seen, 2));
}

PROPERTY(Strategies, record_what_replays_with_the_same_trace, ()) {
  using enum Step::Kind;
  const SmallProgram program = *any_small_program({add, count, wait, post, sleep, time_out, ask});
  const std::string name = *rc::gen::elementOf(strategy_names());
  const Scenario scenario = scenario_of(program);
  const auto strategy = make_strategy(name);
  Explorer explorer{world()};
  for (std::uint64_t i = 1; i <= 10; ++i) {
    const Failure recorded =
        explorer.record(scenario, *strategy, Explorer::seed_of(*rc::gen::arbitrary<unsigned>(), i));
    strategy->learn({});
    const auto schedule = parse_schedule(to_string(recorded.schedule));
    if (!schedule) RC_FAIL(schedule.error().reason);
    const ReplayReport replayed = explorer.replay(scenario, *schedule, nullptr);
    RC_ASSERT(!replayed.divergence);
    RC_ASSERT(replayed.trace_hash == recorded.trace_hash);
    RC_ASSERT((replayed.outcome == recorded.outcome));
    RC_ASSERT(replayed.at == recorded.at);
  }
}

}  // namespace
}  // namespace property_tests
