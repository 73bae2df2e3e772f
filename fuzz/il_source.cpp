// The source of an instruction-list program: whatever the text, it is refused at a place of it, or compiled and run for some
// scans, within the instructions that a scan may take. Once for the addresses of the soft PLC and once for the devices of an
// FX.
//
// Each scan is run on one machine at once and on another one in slices: both do the same. Inputs are a pattern that changes
// from scan to scan.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "emulator_models/device_memory.hpp"
#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"
#include "fuzz/il_mutator.hpp"
#include "fuzz/text_input.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace emulator_models::soft_plc;
using emulator_models::DeviceMemory;
using ltsim::expect;
using std::chrono::nanoseconds;

constexpr int scans = 3;
constexpr std::uint64_t instructions_per_scan_max = 2000;
constexpr std::uint64_t slice_length = 7;

void fill_inputs(std::span<std::byte> inputs, int scan) {
  for (std::size_t i = 0; i < inputs.size(); ++i)
    inputs[i] = static_cast<std::byte>(scan == 0 ? 0xFF : 0x55 * scan + static_cast<int>(i));
}

/// Just as long as the program says that it needs: a byte beyond is not there.
class ExactImage {
 public:
  explicit ExactImage(const IlProgram& program)
      : inputs_(needed(program, Area::inputs)),
        outputs_(needed(program, Area::outputs)),
        memory_(needed(program, Area::memory)) {}

  [[nodiscard]] ProcessImage spans() noexcept { return {inputs_, outputs_, memory_}; }
  [[nodiscard]] std::span<std::byte> inputs() noexcept { return inputs_; }
  bool operator==(const ExactImage&) const = default;

 private:
  static std::size_t needed(const IlProgram& program, Area area) {
    return program.image_bytes_needed[static_cast<std::size_t>(area)];
  }

  std::vector<std::byte> inputs_;
  std::vector<std::byte> outputs_;
  std::vector<std::byte> memory_;
};

class FxImage {
 public:
  explicit FxImage(const IlProgram&) : memory_{protocol::fx::Model::fx3u} {}

  [[nodiscard]] ProcessImage spans() noexcept {
    return {memory_.inputs(), memory_.outputs(), memory_.bytes()};
  }
  [[nodiscard]] std::span<std::byte> inputs() noexcept { return memory_.inputs(); }
  bool operator==(const FxImage& other) const {
    return std::ranges::equal(memory_.bytes(), other.memory_.bytes());
  }

 private:
  DeviceMemory memory_;
};

using ScanResult = std::optional<RunTimeFault>;

ScanResult run_at_once(IlMachine& machine, const ProcessImage& image, nanoseconds now) {
  const auto executed = machine.run_scan(image, now, instructions_per_scan_max);
  if (!executed) return executed.error();
  expect(*executed <= instructions_per_scan_max, "a scan takes no more instructions than it may");
  return std::nullopt;
}

ScanResult run_in_slices(IlMachine& machine, const ProcessImage& image, nanoseconds now) {
  // A slice ends at a jump; each makes at least one instruction.
  for (std::uint64_t slices = 0;; ++slices) {
    expect(slices <= instructions_per_scan_max, "a scan ends");
    const auto end = machine.run_slice(image, now, slice_length, instructions_per_scan_max);
    if (!end) return end.error();
    if (*end == SliceEnd::scan) return std::nullopt;
  }
}

void expect_equal_variables(const IlProgram& program, const IlMachine& one, const IlMachine& other) {
  constexpr std::size_t looked_at_max = 64;
  for (std::size_t i = 0; i < std::min(program.variables.size(), looked_at_max); ++i) {
    const std::string& name = program.variables[i].name;
    expect(one.value(name) == other.value(name), "a scan in slices does what a scan at once does");
  }
}

template <typename Image>
void run(std::string_view text, const IlProgram& program) {
  IlMachine machine{program};
  IlMachine sliced_machine{program};
  Image image{program};
  Image sliced_image{program};
  for (int scan = 0; scan < scans; ++scan) {
    const nanoseconds now = std::chrono::milliseconds{700} * scan;
    fill_inputs(image.inputs(), scan);
    fill_inputs(sliced_image.inputs(), scan);
    const std::vector<std::byte> inputs(image.inputs().begin(), image.inputs().end());
    const ScanResult result = run_at_once(machine, image.spans(), now);
    const ScanResult sliced = run_in_slices(sliced_machine, sliced_image.spans(), now);
    expect(result == sliced && image == sliced_image, "a scan in slices does what a scan at once does");
    expect_equal_variables(program, machine, sliced_machine);
    expect(std::ranges::equal(inputs, image.inputs()), "inputs are never written");
    if (!result) continue;
    expect(fuzz::is_inside(text, result->place.line, result->place.column),
           "a fault at run time names a place of the source");
    expect(result->kind != FaultKind::image_too_small, "a program needs no more than it says");
  }
}

/// But for the bytes of the variables: instances of function blocks have gaps, in which anything may stand.
bool is_same(const IlProgram& one, const IlProgram& other) {
  const auto is_same_instruction = [](const Instruction& a, const Instruction& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  };
  return std::ranges::equal(one.code, other.code, is_same_instruction) && one.places == other.places &&
         one.constants == other.constants && one.initial_variables.size() == other.initial_variables.size() &&
         one.retained_bytes == other.retained_bytes && one.image_bytes_needed == other.image_bytes_needed &&
         one.warnings == other.warnings;
}

void check_error(std::string_view text, const IlError& error) {
  expect(fuzz::is_inside(text, error.place.line, error.place.column),
         "a mistake is at a place of the source");
  expect(!error.message.empty(), "a mistake is told");
}

template <typename Image, typename Compile>
void compile_and_run(std::string_view text, const Compile& compile_text) {
  const auto program = compile_text(text);
  const auto swapped = compile_text(fuzz::with_cases_swapped(text));
  expect(program.has_value() == swapped.has_value(), "lower case counts as upper case");
  if (!program) {
    expect(program.error().place == swapped.error().place, "lower case counts as upper case");
    check_error(text, program.error());
    return;
  }
  expect(is_same(*program, *swapped), "lower case counts as upper case");
  for (const IlError& warning : program->warnings) check_error(text, warning);
  expect(program->code.size() == program->places.size() && !program->code.empty() &&
             program->code.back().opcode == Opcode::end_scan,
         "code ends, and each instruction has a place");
  run<Image>(text, *program);
}

}  // namespace

FUZZ_TARGET("il-source", {.mutate = fuzz::mutate_instruction_list},
            "the source of an instruction-list program: compiled, and run for some scans") {
  const std::string_view text = fuzz::text_of(input);
  compile_and_run<ExactImage>(text, [](std::string_view source) { return compile(source); });
  static const emulator_models::FxAddressMap fx_devices{protocol::fx::Model::fx3u};
  compile_and_run<FxImage>(text, [](std::string_view source) { return compile(source, fx_devices); });
}
