#include "property_tests/sim_clock/small_program.hpp"

#include <fcntl.h>
#include <semaphore.h>

#include <array>
#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <ostream>
#include <string>
#include <thread>

namespace property_tests {
namespace {

struct Shared {
  std::array<std::atomic<int>, 2> words{};
  std::array<int, 2> updates{};
  int answers_that_were_not_0 = 0;
};

sem_t* semaphore(unsigned which) { return sem_open(which == 0 ? "/one" : "/other", O_CREAT, 0600, 0); }

void wait_1_ms(sem_t* waited_for) {
  timespec deadline{};
  clock_gettime(CLOCK_REALTIME, &deadline);
  deadline.tv_nsec += 1'000'000;
  if (deadline.tv_nsec >= 1'000'000'000) {
    deadline.tv_nsec -= 1'000'000'000;
    ++deadline.tv_sec;
  }
  sem_timedwait(waited_for, &deadline);
}

void perform(const Step& step, Shared& shared, ltsim::World& world) {
  using enum Step::Kind;
  switch (step.kind) {
    case add:
      shared.words[step.which] = shared.words[step.which] + 1;
      ++shared.updates[step.which];
      return;
    case count:
      ++shared.words[step.which];
      ++shared.updates[step.which];
      return;
    case wait:
      sem_wait(semaphore(step.which));
      return;
    case post:
      sem_post(semaphore(step.which));
      return;
    case sleep:
      std::this_thread::sleep_for(std::chrono::milliseconds{step.which + 1});
      return;
    case time_out:
      wait_1_ms(semaphore(step.which));
      return;
    case ask:
      if (world.choose("answer", 3) != 0) ++shared.answers_that_were_not_0;
      return;
  }
}

}  // namespace

void showValue(const SmallProgram& program, std::ostream& out) {
  constexpr const char* names[] = {"add", "count", "wait", "post", "sleep", "time-out", "ask"};
  for (const auto& task : program.tasks) {
    for (const Step& step : task) out << names[static_cast<std::size_t>(step.kind)] << step.which << ' ';
    out << "| ";
  }
}

rc::Gen<SmallProgram> any_small_program(std::vector<Step::Kind> kinds) {
  return rc::gen::exec([kinds = std::move(kinds)] {
    SmallProgram program;
    program.tasks.resize(*rc::gen::inRange<std::size_t>(2, 4));
    for (auto& task : program.tasks) {
      task = *rc::gen::container<std::vector<Step>>(
          *rc::gen::inRange<std::size_t>(1, 5),
          rc::gen::exec([kinds] { return Step{*rc::gen::elementOf(kinds), *rc::gen::inRange(0U, 2U)}; }));
    }
    return program;
  });
}

ltsim::Scenario scenario_of(const SmallProgram& program) {
  return {"property/small-program", "", [program](ltsim::World& world) {
            const auto shared = std::make_shared<Shared>();
            for (std::size_t i = 0; i < program.tasks.size(); ++i) {
              world.process("p").start("task" + std::to_string(i),
                                       [shared, &world, &steps = program.tasks[i]] {
                                         for (const Step& step : steps) perform(step, *shared, world);
                                       });
            }
            world.run();
            for (std::size_t i = 0; i < shared->words.size(); ++i)
              world.require(shared->words[i] == shared->updates[i], "an update was lost");
            world.require(shared->answers_that_were_not_0 < 2, "two answers");
          }};
}

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

}  // namespace property_tests
