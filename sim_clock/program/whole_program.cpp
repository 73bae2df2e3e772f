#include "sim_clock/program/whole_program.hpp"

#include <sys/single_threaded.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/program/exit_handlers.hpp"
#include "sim_clock/program/launch.hpp"
#include "sim_clock/program/output_capture.hpp"
#include "sim_clock/scenario/command_line.hpp"
#include "sim_clock/scenario/scenario.hpp"

namespace ltsim {
namespace {

class WholeProgram {
 public:
  explicit WholeProgram(const ProgramStart& start) : start_(start) {
    __libc_single_threaded = 0;  // a variable of the program, if its code looks at it: see World
    const auto variables = ProgramImage::variables();
    variables_.assign(variables.begin(), variables.end());
    ProgramHeap::keep_for_each_execution();
    ExitHandlers::keep_for_each_execution();
  }

  void execute(World& world) {
    restore();
    world.set_exit([&world](const World::Exit& how) { exit(world, how); });
    world.process("program").start("main", [this, &world] {
      const int status =
          start_.main(static_cast<int>(arguments_.size()), pointers_.data(), start_.environment);
      exit(world, {.status = status, .stack = __builtin_frame_address(0)});
    });
    capture_.begin();
    try {
      world.run();
    } catch (const World::Abandoned&) {
      world.set_output(capture_.end());
      throw;
    }
    world.set_output(capture_.end());
  }

 private:
  void restore() {
    const auto variables = ProgramImage::variables();
    std::memcpy(variables.data(), variables_.data(), variables.size());
    ProgramHeap::restore();
    ExitHandlers::restore();
    // main() may change the strings and the array.
    arguments_ = start_.arguments;
    pointers_.clear();
    for (std::string& argument : arguments_) pointers_.push_back(argument.data());
    pointers_.push_back(nullptr);
  }

  /// In the task that ends the program, or has returned from main().
  static void exit(World& world, const World::Exit& how) {
    if (how.is_orderly) {
      Scheduler::destroy_thread_locals(*current_task);
      ExitHandlers::run();
      world.program_memory().check_leaks(how.stack);
    }
    constexpr int status_mask = 0xff;  // of which a parent gets to know
    const int status = how.status & status_mask;
    if (status != 0)
      world.scheduler().fail(OutcomeKind::exit, fmt::format("the program ended with status {}", status));
    world.finish();
  }

  const ProgramStart& start_;
  std::vector<std::byte> variables_;
  std::vector<std::string> arguments_;
  std::vector<char*> pointers_;
  OutputCapture capture_;
};

}  // namespace

int run_whole_program(const ProgramStart& start, const std::vector<std::string>& command) {
  WholeProgram program{start};
  const std::string name = scenario_name_of(start.arguments.front());
  add_program_scenario({.name = name,
                        .description = "a whole program",
                        .body = [&program](World& world) { program.execute(world); },
                        .program = start.arguments});
  std::vector<const char*> arguments;
  for (const std::string& word : command) arguments.push_back(word.c_str());
  return run_command_line(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace ltsim
