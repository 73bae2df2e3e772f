// Programs in instruction list, compiled and run, do what a naive evaluator makes of their trees; in slices as at once.

#include <sstream>

#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"
#include "property_tests/emulator_models/soft_plc/naive_evaluator.hpp"
#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

using namespace emulator_models::soft_plc;
using std::chrono::nanoseconds;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) lines.push_back(line + "\n");
  return lines;
}

/// What the accumulator holds of a number: its low 64 bits.
std::uint64_t bits(Wide number) { return static_cast<std::uint64_t>(number); }

rc::Gen<std::vector<std::uint8_t>> any_tape() {
  return rc::gen::scale(
      3.0, rc::gen::container<std::vector<std::uint8_t>>(rc::gen::inRange<std::uint8_t>(0, 240)));
}

PROPERTY(InstructionList, does_what_a_naive_evaluation_of_the_program_does, ()) {
  const auto bytes = *any_tape();
  const auto scans = *rc::gen::container<std::vector<std::uint8_t>>(24, rc::gen::arbitrary<std::uint8_t>());
  Tape tape{bytes};
  const GeneratedProgram program = program_of(tape);
  const std::string source = source_of(program);
  RC_LOG() << source;
  const FuzzInput input{"il-source", lines_of(source)};

  const auto compiled = compile(source);
  if (!compiled) RC_FAIL(to_string(compiled.error()));
  IlMachine machine{*compiled};
  IlMachine sliced{*compiled};
  NaiveEvaluator naive{program};
  Tape happenings{scans};
  nanoseconds now{0};
  while (!happenings.is_at_end()) {
    now += std::chrono::milliseconds{happenings.choose(30)};
    for (const char* const name : {"N_BOOL_1", "N_BOOL_2", "N_INT_1"}) {
      const Wide value =
          name[2] == 'B' ? Wide{happenings.flip()} : Wide{40} - Wide{static_cast<int>(happenings.choose(80))};
      naive.values[name] = value;
      RC_ASSERT(machine.set_value(name, bits(value)));
      RC_ASSERT(sliced.set_value(name, bits(value)));
    }
    const auto expected = naive.scan(now.count());
    const auto result = machine.run_scan({}, now);
    RC_ASSERT(result.has_value() == !expected.has_value());
    if (!result) RC_ASSERT(to_string(result.error().kind) == to_string(*expected));
    auto slice = sliced.run_slice({}, now, 1);
    while (slice && *slice == SliceEnd::length) slice = sliced.run_slice({}, now + nanoseconds{1}, 1);
    RC_ASSERT(slice.has_value() == result.has_value());
    for (const auto& variable : program.variables) {
      const auto found = machine.value(variable.name);
      if (found != bits(naive.values[variable.name])) RC_FAIL(variable.name + " differs");
      RC_ASSERT(sliced.value(variable.name) == found);
    }
    if (!result) return;
  }
}

}  // namespace
}  // namespace property_tests
