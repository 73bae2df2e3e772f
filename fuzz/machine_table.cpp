// The machine table of the kernel: whatever the text, it is refused with a place and a reason, or it keeps the rules of a
// machine table, plans every M function that it has and no other, and prints and reads as itself.

#include <array>
#include <string>

#include <fmt/format.h>

#include "fuzz/kernel_file_place.hpp"
#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/machine_table_file.hpp"

namespace {

using namespace kernel_mocks;
using ltsim::expect;

std::string_view synchronisation_of(const MachineFunction& function) {
  if (!function.sent_to_plc) return "NO_SYNCH";
  switch (function.acknowledgement) {
    case Acknowledgement::before_next_function:
      return "MOS";
    case Acknowledgement::at_block_end:
      return "MVS_SNS";
    case Acknowledgement::before_feed:
      return "MVS_SLM";
    case Acknowledgement::before_going_on:
      break;
  }
  return function.effect == EffectPoint::begin ? "MVS_SVS" : "MNS_SNS";
}

std::string row_of(const MachineFunction& function) {
  constexpr std::array flows{"none", "stop", "optional-stop", "end"};
  constexpr std::array spindles{"none", "start", "stop"};
  return fmt::format(
      "[[function]]\nm = {}\neffect = \"{}\"\nsynchronisation = \"{}\"\nflow = \"{}\"\norder = {}\n"
      "spindle = \"{}\"\n",
      function.code, function.effect == EffectPoint::begin ? "begin" : "end", synchronisation_of(function),
      flows.at(static_cast<std::size_t>(function.flow)), function.rank,
      spindles.at(static_cast<std::size_t>(function.spindle)));
}

void check_function(const MachineFunction& function, const MachineTable& table) {
  expect(function.code != 98, "there are no subprograms");
  expect(function.flow == ProgramFlow::none || function.effect == EffectPoint::end,
         "a stop acts at the end of its block");
  Block block;
  block.line = 1;
  block.words.push_back({'M', Decimal::from_whole(function.code)});
  const auto plan = plan_block(block, table);
  expect(plan && plan->flow == function.flow &&
             plan->begin.size() + plan->end.size() == (function.sent_to_plc ? 1U : 0U),
         "a function of the table can be planned");
}

}  // namespace

FUZZ_TARGET("machine-table", {}, "the text of a machine table: parsed, used, printed and parsed again") {
  const std::string_view text = fuzz::text_of(input);
  const auto table = parse_machine_table(text);
  if (!table) {
    fuzz::check_refusal(text, table.error());
    return;
  }
  std::string printed;
  for (unsigned code = 0; code <= MachineTable::code_max; ++code) {
    const MachineFunction* const function = table->find(static_cast<std::uint8_t>(code));
    if (function == nullptr) continue;
    check_function(*function, *table);
    printed += row_of(*function);
  }
  if (printed.empty()) printed = "function = []\n";
  const auto again = parse_machine_table(printed);
  expect(again && *again == *table, "a machine table that is printed reads as itself");
}
