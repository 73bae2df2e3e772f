#include "sim_clock/program/program_executions.hpp"

#include <bit>
#include <cstdio>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "sim_clock/explore/memory_across_forks.hpp"
#include "sim_clock/scenario/command_line.hpp"
#include "sim_clock/world/task_storage.hpp"

namespace ltsim {

ProgramExecutions::ProgramExecutions()
    : has_told_left_open_(new(new_shared_memory(sizeof(std::atomic<bool>))) std::atomic<bool>{false}) {}

void ProgramExecutions::prepare() {
  if (capture_) return;
  TaskStorage{}.reset();  // looks up where thread-locals lie: once, and not in each process that is forked
  descriptors_.emplace();
  capture_.emplace();  // another process has one of its own
}

void ProgramExecutions::begin() {
  prepare();
  if (count_ != 0) {
    kept_.restore();
    if (std::has_single_bit(count_)) tell_left_open();
    descriptors_->close_left_open();
  }
  ++count_;
  descriptors_->rewind_input();
}

void ProgramExecutions::tell_left_open() {
  const std::vector<int> left = descriptors_->left_open();
  if (left.empty() || has_told_left_open_->exchange(true)) return;
  fmt::print(stderr,
             "ltsim: an execution has left {} open: closed before the next. A library that goes on to use "
             "what it had opened needs \"--state fork\"\n",
             left.size() == 1 ? fmt::format("descriptor {}", left.front())
                              : fmt::format("{} descriptors", left.size()));
}

void ProgramExecutions::run(World& world) {
  capture_->begin();
  try {
    world.run();
  } catch (const World::Abandoned&) {
    world.set_output(capture_->end());
    throw;
  }
  world.set_output(capture_->end());
}

int run_program_command(Scenario scenario, const std::vector<std::string>& command) {
  add_program_scenario(std::move(scenario));
  std::vector<const char*> arguments;
  for (const std::string& word : command) arguments.push_back(word.c_str());
  return run_command_line(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace ltsim
