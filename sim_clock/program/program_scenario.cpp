#include "sim_clock/program/program_scenario.hpp"

#include <utility>

#include "sim_clock/scenario/command_line.hpp"

namespace ltsim {

void run_captured(World& world, OutputCapture& capture) {
  capture.begin();
  try {
    world.run();
  } catch (const World::Abandoned&) {
    world.set_output(capture.end());
    throw;
  }
  world.set_output(capture.end());
}

int run_program_command(Scenario scenario, const std::vector<std::string>& command) {
  add_program_scenario(std::move(scenario));
  std::vector<const char*> arguments;
  for (const std::string& word : command) arguments.push_back(word.c_str());
  return run_command_line(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace ltsim
