#include "sim_clock/program/whole_program.hpp"

#include <sys/single_threaded.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "sim_clock/explore/memory_across_forks.hpp"
#include "sim_clock/program/exit_handlers.hpp"
#include "sim_clock/program/launch.hpp"
#include "sim_clock/program/open_descriptors.hpp"
#include "sim_clock/program/output_capture.hpp"
#include "sim_clock/scenario/command_line.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "sim_clock/world/task_storage.hpp"

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
    make_arguments();
  }

  /// What the executions of a process, and of those that it forks, have in common.
  void prepare() {
    if (capture_) return;
    TaskStorage{}.reset();  // looks up where thread-locals lie: once, and not in each process that is forked
    descriptors_.emplace();
    capture_.emplace();  // another process has one of its own
  }

  void execute(World& world) {
    prepare();
    if (executions_ != 0) restore();
    ++executions_;
    descriptors_->rewind_input();
    world.set_exit([&world](const World::Exit& how) { exit(world, how); });
    world.process("program").start("main", [this, &world] {
      const int status =
          start_.main(static_cast<int>(arguments_.size()), pointers_.data(), start_.environment);
      exit(world, {.status = status, .stack = __builtin_frame_address(0)});
    });
    capture_->begin();
    try {
      world.run();
    } catch (const World::Abandoned&) {
      world.set_output(capture_->end());
      throw;
    }
    world.set_output(capture_->end());
  }

 private:
  void restore() {
    const auto variables = ProgramImage::variables();
    std::memcpy(variables.data(), variables_.data(), variables.size());
    ProgramHeap::restore();
    ExitHandlers::restore();
    if (std::has_single_bit(executions_)) tell_left_open();
    descriptors_->close_left_open();
    make_arguments();
  }

  void tell_left_open() {
    const std::vector<int> left = descriptors_->left_open();
    if (left.empty() || has_told_left_open_->exchange(true)) return;
    fmt::print(stderr,
               "ltsim: an execution has left {} open: closed before the next. A library that goes on to use "
               "what it had opened needs \"--state fork\"\n",
               left.size() == 1 ? fmt::format("descriptor {}", left.front())
                                : fmt::format("{} descriptors", left.size()));
  }

  /// main() may change the strings and the array.
  void make_arguments() {
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
  std::uint64_t executions_ = 0;  // that have begun in this process
  std::vector<std::byte> variables_;
  std::vector<std::string> arguments_;
  std::vector<char*> pointers_;
  std::optional<OpenDescriptors> descriptors_;
  std::optional<OutputCapture> capture_;
  /// By one of the processes that are forked from here on.
  std::atomic<bool>* has_told_left_open_ =
      new (new_shared_memory(sizeof(std::atomic<bool>))) std::atomic<bool>{false};
};

}  // namespace

int run_whole_program(const ProgramStart& start, const std::vector<std::string>& command) {
  WholeProgram program{start};
  const std::string name = scenario_name_of(start.arguments.front());
  add_program_scenario({.name = name,
                        .description = "a whole program",
                        .body = [&program](World& world) { program.execute(world); },
                        .program = start.arguments,
                        .prepare = [&program] { program.prepare(); }});
  std::vector<const char*> arguments;
  for (const std::string& word : command) arguments.push_back(word.c_str());
  return run_command_line(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace ltsim
