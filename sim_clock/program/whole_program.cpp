#include "sim_clock/program/whole_program.hpp"

#include <fmt/format.h>

#include "sim_clock/program/exit_handlers.hpp"
#include "sim_clock/program/launch.hpp"
#include "sim_clock/program/main_arguments.hpp"
#include "sim_clock/program/program_executions.hpp"

namespace ltsim {
namespace {

class WholeProgram {
 public:
  explicit WholeProgram(const ProgramStart& start) : start_(start) {}

  void prepare() { executions_.prepare(); }

  void execute(World& world) {
    executions_.begin();
    arguments_.begin(start_.arguments);
    world.set_exit([&world](const World::Exit& how) { exit(world, how); });
    world.process("program").start("main", [this, &world] {
      const int status = start_.main(arguments_.count(), arguments_.pointers(), start_.environment);
      exit(world, {.status = status, .stack = __builtin_frame_address(0)});
    });
    executions_.run(world);
  }

 private:
  /// In the task that ends the program, or has returned from main().
  static void exit(World& world, const World::Exit& how) {
    if (how.is_orderly) {
      Scheduler::destroy_thread_locals(*current_task);
      ExitHandlers::run(current_task->process);
      world.program_memory().check_leaks(how.stack);
    }
    const int status = how.status & exit_status_mask;
    if (status != 0)
      world.scheduler().fail(OutcomeKind::exit, fmt::format("the program ended with status {}", status));
    world.finish();
  }

  const ProgramStart& start_;
  ProgramExecutions executions_;
  MainArguments arguments_;
};

}  // namespace

int run_whole_program(const ProgramStart& start, const std::vector<std::string>& command) {
  WholeProgram program{start};
  const std::string name = scenario_name_of(start.arguments);
  return run_program_command({.name = name,
                              .description = "a whole program",
                              .body = [&program](World& world) { program.execute(world); },
                              .program = start.arguments,
                              .prepare = [&program] { program.prepare(); }},
                             command);
}

}  // namespace ltsim
