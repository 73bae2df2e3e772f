#include "kernel_mocks/machine_table.hpp"

#include <algorithm>
#include <array>

namespace kernel_mocks {
namespace {

using enum EffectPoint;
using enum Acknowledgement;

constexpr std::uint8_t tool_change_first = 0;
constexpr std::uint8_t usual = 1;
constexpr std::uint8_t stop_last = 2;

constexpr std::array function_table{
    // Program flow. Stops and ends come after all else of their block.
    MachineFunction{0, end, stop_last, before_going_on, true, ProgramFlow::stop},
    MachineFunction{1, end, stop_last, before_going_on, true, ProgramFlow::optional_stop},
    MachineFunction{2, end, stop_last, before_going_on, true, ProgramFlow::end},
    MachineFunction{30, end, stop_last, before_going_on, true, ProgramFlow::end},
    MachineFunction{60, end, usual, before_going_on},
    MachineFunction{99, end, stop_last, before_going_on, false, ProgramFlow::end},
    // Spindle and coolant: on at the begin, off at the end.
    MachineFunction{3, begin},
    MachineFunction{4, begin},
    MachineFunction{5, end},
    MachineFunction{7, begin},
    MachineFunction{8, begin},
    MachineFunction{9, end},
    MachineFunction{13, begin},
    MachineFunction{14, begin},
    MachineFunction{19, end},
    // The tool change stops the spindle, so it precedes an M3 of its block.
    MachineFunction{6, begin, tool_change_first},
    // Clamp before the block's motion, unclamp before it too.
    MachineFunction{10, begin},
    MachineFunction{11, begin},
    // Overrides concern the kernel's own feed: nothing moves, nothing has to be waited for.
    MachineFunction{48, end, usual, before_next_function},
    MachineFunction{49, begin, usual, before_next_function},
};

// M100 to M199 are the machine builder's: all alike.
constexpr std::uint8_t builder_code_min = 100;
constexpr std::uint8_t builder_code_max = 199;

constexpr std::array builder_table = [] {
  std::array<MachineFunction, builder_code_max - builder_code_min + 1> table{};
  for (std::size_t index = 0; index < table.size(); ++index) {
    table[index].code = static_cast<std::uint8_t>(builder_code_min + index);
  }
  return table;
}();

}  // namespace

const MachineFunction* machine_function(std::uint8_t code) noexcept {
  if (code >= builder_code_min && code <= builder_code_max) return &builder_table[code - builder_code_min];
  const auto found = std::ranges::find(function_table, code, &MachineFunction::code);
  return found == function_table.end() ? nullptr : &*found;
}

}  // namespace kernel_mocks
