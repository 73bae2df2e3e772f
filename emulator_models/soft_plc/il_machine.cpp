#include "emulator_models/soft_plc/il_machine.hpp"

#include <algorithm>

#include "emulator_models/soft_plc/il_blocks.hpp"

namespace emulator_models::soft_plc {
namespace {

/// Where the areas begin. Those that a program cannot write have no entry to write through.
struct Areas {
  std::array<const std::byte*, areas_count> read{};
  std::array<std::byte*, areas_count> write{};

  [[nodiscard]] const std::byte* source(const Instruction& in) const noexcept {
    return read[static_cast<std::size_t>(in.area)] + in.offset;
  }
  [[nodiscard]] std::byte* target(const Instruction& in) const noexcept {
    return write[static_cast<std::size_t>(in.area)] + in.offset;
  }
  /// 0 or 1
  [[nodiscard]] std::uint64_t bit(const Instruction& in) const noexcept {
    return (std::to_integer<unsigned>(*source(in)) >> in.detail) & 1U;
  }
};

/// @param bit  0 or 1
void write_bit(std::byte* target, unsigned index, std::uint64_t bit) noexcept {
  const unsigned others = std::to_integer<unsigned>(*target) & ~(1U << index);
  *target = static_cast<std::byte>(others | static_cast<unsigned>(bit) << index);
}

std::uint64_t inverted(ElementaryType type, std::uint64_t bits) noexcept { return wrapped(type, ~bits); }

}  // namespace

std::string to_string(const RunTimeFault& fault) {
  return to_string(IlError{fault.place, std::string{to_string(fault.kind)}});
}

IlMachine::IlMachine(const IlProgram& program) : program_{program}, variables_{program.initial_variables} {}

void IlMachine::start(Start kind) noexcept {
  const std::size_t kept = kind == Start::warm ? program_.retained_bytes : 0;
  std::copy(program_.initial_variables.begin() + static_cast<std::ptrdiff_t>(kept),
            program_.initial_variables.end(), variables_.begin() + static_cast<std::ptrdiff_t>(kept));
  image_is_to_be_initialized_ = kind == Start::cold;
  abandon_scan();
}

bool IlMachine::image_suffices(const ProcessImage& image) const noexcept {
  const auto& needed = program_.image_bytes_needed;
  return image.inputs.size() >= needed[static_cast<std::size_t>(Area::inputs)] &&
         image.outputs.size() >= needed[static_cast<std::size_t>(Area::outputs)] &&
         image.memory.size() >= needed[static_cast<std::size_t>(Area::memory)];
}

void IlMachine::initialize(const ProcessImage& image) noexcept {
  for (const ImageInitial& initial : program_.image_initials) {
    std::byte* const target =
        (initial.area == Area::outputs ? image.outputs : image.memory).data() + initial.offset;
    if (initial.type == ElementaryType::boolean) {
      write_bit(target, initial.bit_index, initial.bits);
    } else {
      store(initial.type, target, initial.bits);
    }
  }
  image_is_to_be_initialized_ = false;
}

tl::expected<std::uint64_t, RunTimeFault> IlMachine::run_scan(const ProcessImage& image,
                                                              std::chrono::nanoseconds now,
                                                              std::uint64_t budget) noexcept {
  abandon_scan();
  Progress progress{.now = now};
  const auto end = run(image, progress, budget, budget);
  if (!end) return tl::unexpected(end.error());
  return progress.executed;
}

tl::expected<SliceEnd, RunTimeFault> IlMachine::run_slice(const ProcessImage& image,
                                                          std::chrono::nanoseconds now,
                                                          std::uint64_t slice_length,
                                                          std::uint64_t budget) noexcept {
  if (!suspended_) suspended_.emplace(Progress{.now = now});
  const std::uint64_t slice_end = suspended_->executed + slice_length;
  const auto end = run(image, *suspended_, std::min(slice_end, budget), budget);
  if (!end || *end == SliceEnd::scan) abandon_scan();
  return end;
}

tl::expected<SliceEnd, RunTimeFault> IlMachine::run(const ProcessImage& image, Progress& progress,
                                                    std::uint64_t limit, std::uint64_t budget) noexcept {
  if (!image_suffices(image)) return tl::unexpected(RunTimeFault{FaultKind::image_too_small, {}});
  if (image_is_to_be_initialized_) initialize(image);

  Areas areas;
  areas.read = {variables_.data(), reinterpret_cast<const std::byte*>(program_.constants.data()),
                image.inputs.data(), image.outputs.data(), image.memory.data()};
  areas.write = {variables_.data(), nullptr, nullptr, image.outputs.data(), image.memory.data()};
  std::array<std::uint64_t, nesting_max> slots = progress.slots;

  const Instruction* const code = program_.code.data();
  const Instruction* next = code + progress.next;
  // Instructions are counted by straight pieces, at the jump that ends one: that keeps the count out of the
  // path of all others.
  const Instruction* piece = next;
  std::uint64_t executed = progress.executed;
  std::uint64_t acc = progress.acc;

  const auto fault = [&](FaultKind kind) {
    return tl::unexpected(RunTimeFault{kind, program_.places[static_cast<std::size_t>(next - 1 - code)]});
  };
  const auto piece_is_within_limit = [&] {
    executed += static_cast<std::uint64_t>(next - piece);
    return executed <= limit;
  };
  const auto stop_at_jump = [&](const Instruction& jump) -> tl::expected<SliceEnd, RunTimeFault> {
    if (executed > budget) return fault(FaultKind::budget_spent);
    progress = {jump.offset, executed, acc, slots, progress.now};
    return SliceEnd::length;
  };

  for (;;) {
    const Instruction in = *next++;
    switch (in.opcode) {
      case Opcode::load_bit:
        acc = areas.bit(in);
        break;
      case Opcode::load_bit_not:
        acc = areas.bit(in) ^ 1U;
        break;
      case Opcode::store_bit:
        write_bit(areas.target(in), in.detail, acc);
        break;
      case Opcode::store_bit_not:
        write_bit(areas.target(in), in.detail, acc ^ 1U);
        break;
      case Opcode::set_bit:
        *areas.target(in) |= static_cast<std::byte>(acc << in.detail);
        break;
      case Opcode::reset_bit:
        *areas.target(in) &= static_cast<std::byte>(~(acc << in.detail));
        break;
      case Opcode::and_bit:
        acc &= areas.bit(in);
        break;
      case Opcode::and_bit_not:
        acc &= areas.bit(in) ^ 1U;
        break;
      case Opcode::or_bit:
        acc |= areas.bit(in);
        break;
      case Opcode::or_bit_not:
        acc |= areas.bit(in) ^ 1U;
        break;
      case Opcode::xor_bit:
        acc ^= areas.bit(in);
        break;
      case Opcode::xor_bit_not:
        acc ^= areas.bit(in) ^ 1U;
        break;
      case Opcode::not_bit:
        acc ^= 1U;
        break;
      case Opcode::and_bit_deferred:
        acc &= slots[in.offset];
        break;
      case Opcode::and_bit_not_deferred:
        acc = slots[in.offset] & (acc ^ 1U);
        break;
      case Opcode::or_bit_deferred:
        acc |= slots[in.offset];
        break;
      case Opcode::or_bit_not_deferred:
        acc = slots[in.offset] | (acc ^ 1U);
        break;
      case Opcode::xor_bit_deferred:
        acc ^= slots[in.offset];
        break;
      case Opcode::xor_bit_not_deferred:
        acc = slots[in.offset] ^ acc ^ 1U;
        break;
      case Opcode::defer:
        slots[in.offset] = acc;
        break;
      case Opcode::restore:
        acc = slots[in.offset];
        break;
      case Opcode::jump_if:
        if (acc == 0) break;
        if (!piece_is_within_limit()) return stop_at_jump(in);
        next = piece = code + in.offset;
        break;
      case Opcode::jump_if_not:
        if (acc != 0) break;
        if (!piece_is_within_limit()) return stop_at_jump(in);
        next = piece = code + in.offset;
        break;
      case Opcode::jump:
        if (!piece_is_within_limit()) return stop_at_jump(in);
        next = piece = code + in.offset;
        break;
      case Opcode::end_scan:
        executed += static_cast<std::uint64_t>(next - piece);
        if (executed > budget) return fault(FaultKind::budget_spent);
        progress.executed = executed;
        return SliceEnd::scan;
      case Opcode::load:
        acc = soft_plc::load(in.type, areas.source(in));
        break;
      case Opcode::load_not:
        acc = inverted(in.type, soft_plc::load(in.type, areas.source(in)));
        break;
      case Opcode::store:
        soft_plc::store(in.type, areas.target(in), acc);
        break;
      case Opcode::store_not:
        soft_plc::store(in.type, areas.target(in), ~acc);
        break;
      case Opcode::complement:
        acc = inverted(in.type, acc);
        break;
      case Opcode::operate:
      case Opcode::operate_not:
      case Opcode::operate_deferred:
      case Opcode::operate_not_deferred: {
        const bool deferred = in.opcode >= Opcode::operate_deferred;
        const bool negated = in.opcode == Opcode::operate_not || in.opcode == Opcode::operate_not_deferred;
        const std::uint64_t left = deferred ? slots[in.offset] : acc;
        const std::uint64_t right = deferred ? acc : soft_plc::load(in.type, areas.source(in));
        const OperationResult result = soft_plc::operate(static_cast<Operation>(in.detail), in.type, left,
                                                         negated ? inverted(in.type, right) : right);
        if (!result) return fault(result.error());
        acc = *result;
        break;
      }
      case Opcode::absolute:
        acc = soft_plc::absolute(in.type, acc);
        break;
      case Opcode::convert: {
        const OperationResult result =
            soft_plc::convert(static_cast<ElementaryType>(in.detail), in.type, acc);
        if (!result) return fault(result.error());
        acc = *result;
        break;
      }
      case Opcode::shift: {
        const OperationResult result =
            soft_plc::shift(static_cast<ShiftKind>(in.detail % 4), static_cast<ElementaryType>(in.detail / 4),
                            acc, in.type, soft_plc::load(in.type, areas.source(in)));
        if (!result) return fault(result.error());
        acc = *result;
        break;
      }
      case Opcode::call_block:
        call(static_cast<BlockKind>(in.detail), areas.target(in), image.memory.data(), progress.now);
        break;
    }
  }
}

std::optional<std::uint64_t> IlMachine::value(std::string_view upper_name) const noexcept {
  const IlVariable* const variable = program_.find(upper_name);
  if (variable == nullptr || variable->area != Area::variables) return std::nullopt;
  return load(variable->type, variables_.data() + variable->offset);
}

bool IlMachine::set_value(std::string_view upper_name, std::uint64_t bits) noexcept {
  const IlVariable* const variable = program_.find(upper_name);
  if (variable == nullptr || variable->area != Area::variables) return false;
  store(variable->type, variables_.data() + variable->offset, wrapped(variable->type, bits));
  return true;
}

}  // namespace emulator_models::soft_plc
