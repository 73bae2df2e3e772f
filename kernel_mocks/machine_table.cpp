#include "kernel_mocks/machine_table.hpp"

#include <array>

#include "protocol/check.hpp"

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
    MachineFunction{3, begin, usual, before_going_on, true, ProgramFlow::none, SpindleEffect::start},
    MachineFunction{4, begin, usual, before_going_on, true, ProgramFlow::none, SpindleEffect::start},
    MachineFunction{5, end, usual, before_going_on, true, ProgramFlow::none, SpindleEffect::stop},
    MachineFunction{7, begin},
    MachineFunction{8, begin},
    MachineFunction{9, end},
    MachineFunction{13, begin, usual, before_going_on, true, ProgramFlow::none, SpindleEffect::start},
    MachineFunction{14, begin, usual, before_going_on, true, ProgramFlow::none, SpindleEffect::start},
    MachineFunction{19, end, usual, before_going_on, true, ProgramFlow::none, SpindleEffect::stop},
    // The tool change stops the spindle, so it precedes an M3 of its block.
    MachineFunction{6, begin, tool_change_first, before_going_on, true, ProgramFlow::none,
                    SpindleEffect::stop},
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

}  // namespace

const MachineTable& MachineTable::standard() noexcept {
  static const MachineTable table = [] {
    MachineTable built;
    for (const MachineFunction& function : function_table) built.put(function);
    for (unsigned code = builder_code_min; code <= builder_code_max; ++code) {
      built.put({.code = static_cast<std::uint8_t>(code)});
    }
    return built;
  }();
  return table;
}

const MachineFunction* MachineTable::find(std::uint8_t code) const noexcept {
  return code <= code_max && functions_[code] ? &*functions_[code] : nullptr;
}

void MachineTable::put(const MachineFunction& function) noexcept {
  PLC_CHECK(function.code <= code_max);
  functions_[function.code] = function;
}

}  // namespace kernel_mocks
