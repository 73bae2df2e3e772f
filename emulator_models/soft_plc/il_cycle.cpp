#include "emulator_models/soft_plc/il_cycle.hpp"

#include <algorithm>
#include <utility>

namespace emulator_models::soft_plc {
namespace {

bool is_bit_store(Opcode opcode) noexcept {
  return opcode == Opcode::store_bit || opcode == Opcode::store_bit_not || opcode == Opcode::set_bit ||
         opcode == Opcode::reset_bit;
}

std::vector<std::byte> written_outputs(const IlProgram& program) {
  std::vector<std::byte> mask(outputs_bytes_max);
  for (const Instruction& in : program.code) {
    if (!writes_operand(in) || in.area != Area::outputs) continue;
    if (is_bit_store(in.opcode)) {
      mask[in.offset] |= static_cast<std::byte>(1U << in.detail);
    } else {
      const Section section = operand_section(in);
      std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(section.first), section.bytes, std::byte{0xFF});
    }
  }
  return mask;
}

}  // namespace

bool writes_operand(const Instruction& in) noexcept {
  return is_bit_store(in.opcode) || in.opcode == Opcode::store || in.opcode == Opcode::store_not;
}

Section operand_section(const Instruction& in) noexcept {
  return {in.offset, is_bit_store(in.opcode) ? 1 : size_bytes(in.type)};
}

IlCycle::IlCycle(IlProgram program)
    : program_{std::move(program)},
      machine_{program_},
      inputs_(inputs_bytes_max),
      outputs_(outputs_bytes_max),
      memory_(memory_bytes_max),
      output_mask_{written_outputs(program_)} {}

void IlCycle::start(StartKind kind) noexcept {
  if (kind == StartKind::cold) {
    std::ranges::fill(outputs_, std::byte{0});
    std::ranges::fill(memory_, std::byte{0});
  }
  machine_.start(kind == StartKind::cold ? IlMachine::Start::cold : IlMachine::Start::warm);
  const std::lock_guard lock{mutex_};
  fault_.reset();
}

Progress IlCycle::execute(const ScanStep& step) noexcept {
  const auto end = machine_.run_slice({inputs_, outputs_, memory_}, step.scan_start, slice_instructions,
                                      scan_instructions_max);
  if (end) return *end == SliceEnd::scan ? Progress::finished : Progress::unfinished;
  const std::lock_guard lock{mutex_};
  fault_ = end.error();
  return Progress::failed;
}

std::optional<SourcePlace> IlCycle::failed_at() const noexcept {
  const auto fault = run_time_fault();
  return fault ? std::optional{fault->place} : std::nullopt;
}

std::optional<RunTimeFault> IlCycle::run_time_fault() const noexcept {
  const std::lock_guard lock{mutex_};
  return fault_;
}

}  // namespace emulator_models::soft_plc
