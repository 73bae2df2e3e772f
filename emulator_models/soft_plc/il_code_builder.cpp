#include "emulator_models/soft_plc/il_code_builder.hpp"

#include <iterator>

#include "emulator_models/soft_plc/il_failure.hpp"

namespace emulator_models::soft_plc {
namespace {

using State = CurrentResult::State;

std::string quoted(ElementaryType type) { return std::string{name_of(type)}; }

}  // namespace

void check_has_operation(Operation operation, ElementaryType type, SourcePlace place) {
  switch (operation) {
    case Operation::bit_and:
    case Operation::bit_or:
    case Operation::bit_xor:
      if (!is_bits(type)) fail(place, "AND, OR and XOR take BOOL or bit strings, not " + quoted(type));
      return;
    case Operation::add:
    case Operation::sub:
      if (!is_number(type) && type != ElementaryType::time)
        fail(place, "ADD and SUB take numbers or TIME, not " + quoted(type) + ": convert with a function");
      return;
    case Operation::mul:
    case Operation::div:
      if (!is_number(type)) fail(place, "MUL and DIV take numbers, not " + quoted(type) + ": convert first");
      return;
    case Operation::mod:
      if (!is_integer(type)) fail(place, "MOD takes integers, not " + quoted(type));
      return;
    case Operation::minimum:
    case Operation::maximum:
      if (type == ElementaryType::boolean) fail(place, "MIN, MAX and LIMIT take no BOOL: use AND and OR");
      return;
    case Operation::greater:
    case Operation::greater_equal:
    case Operation::equal:
    case Operation::not_equal:
    case Operation::less_equal:
    case Operation::less:
      return;
  }
}

void CodeBuilder::begin_pass() {
  program_.code.clear();
  program_.places.clear();
  program_.constants.clear();
  program_.warnings.clear();
  current_ = {CurrentResult::undefined(), {}};
}

std::size_t CodeBuilder::emit(const Instruction& instruction, SourcePlace place) {
  if (program_.code.size() == code_length_max)
    fail(place, "the program has more than " + std::to_string(code_length_max) + " instructions: shorten it");
  program_.code.push_back(instruction);
  program_.places.push_back(place);
  return program_.code.size() - 1;
}

std::size_t CodeBuilder::emit(Opcode opcode, const ValuePlace& value, SourcePlace place,
                              std::uint8_t detail) {
  if (value.type == ElementaryType::boolean) detail = value.bit_index;
  return emit({opcode, value.area, detail, value.type, value.offset}, place);
}

void CodeBuilder::point_to_next(std::size_t jump_index) {
  program_.code[jump_index].offset = static_cast<std::uint32_t>(next_index());
}

ValuePlace CodeBuilder::constant(ElementaryType type, std::uint64_t bits) {
  program_.constants.push_back(bits);
  const std::size_t offset = (program_.constants.size() - 1) * sizeof(std::uint64_t);
  return {type, Area::constants, static_cast<std::uint32_t>(offset), 0, "a literal"};
}

void CodeBuilder::set_cr(CurrentResult cr) { current_ = {cr, {}}; }

PendingResult CodeBuilder::take() {
  PendingResult taken = std::move(current_);
  set_cr(CurrentResult::undefined());
  return taken;
}

void CodeBuilder::require_cr(SourcePlace place) {
  if (cr().state == State::unreached)
    fail(place, "no way leads to this line: remove it, or put a label before it and jump there");
  if (cr().state == State::undefined)
    fail(place, "CR is not set, or not of one type, on every way to this line: begin with LD");
  if (!cr().after_call) return;
  const IlError warning{
      place, "CR comes from before a CAL: this PLC keeps it, others do not; load it again to be safe"};
  program_.warnings.push_back(warning);  // not moved: gcc 12 would see it read beyond its end
  current_.cr.after_call = false;
}

void CodeBuilder::require_type(ElementaryType type, SourcePlace place, const std::string& what) {
  require_cr(place);
  if (cr().state == State::untyped) {
    settle(current_.untyped, type);
    set_type(type);
    return;
  }
  if (cr().type != type)
    fail(place, "CR is " + quoted(cr().type) + ", " + what + " needs " + quoted(type) +
                    ": there is no implicit conversion, use a function such as " + quoted(cr().type) +
                    "_TO_" + quoted(type));
}

void CodeBuilder::settle(std::vector<UntypedUse>& uses, ElementaryType type) {
  for (const UntypedUse& use : uses) {
    Instruction& instruction = program_.code[use.code_index];
    if (use.literal) {
      const std::uint64_t bits = literal_value(*use.literal, type, use.place);
      program_.constants[instruction.offset / sizeof(std::uint64_t)] = bits;
    }
    instruction.type = type;
    if (instruction.opcode == Opcode::load) {
      if (type == ElementaryType::boolean) instruction.opcode = Opcode::load_bit;
    } else {
      check_has_operation(static_cast<Operation>(instruction.detail), type, use.place);
    }
  }
  uses.clear();
}

void CodeBuilder::load_literal(const std::string& text, SourcePlace place) {
  const auto literal = parse_literal(text);
  if (!literal) fail(place, text + ": " + literal.error());
  if (literal->type) {
    load(constant(*literal->type, literal_value(text, *literal->type, place)), place);
    return;
  }
  const std::size_t index = emit(Opcode::load, constant(ElementaryType::lint, 0), place);
  current_ = {{State::untyped, {}, false}, {{index, text, place}}};
}

void CodeBuilder::load(const ValuePlace& value, SourcePlace place) {
  emit(value.type == ElementaryType::boolean ? Opcode::load_bit : Opcode::load, value, place);
  set_type(value.type);
}

void CodeBuilder::unify(PendingResult& other, SourcePlace place, const std::string& what) {
  if (other.cr.state == State::typed) {
    require_type(other.cr.type, place, what);
  } else if (cr().state == State::typed) {
    settle(other.untyped, cr().type);
    other.cr = cr();
  }
}

void CodeBuilder::operate_untyped(Operation operation, const std::string& literal, SourcePlace place) {
  const std::size_t index =
      emit(Opcode::operate, constant(ElementaryType::lint, 0), place, static_cast<std::uint8_t>(operation));
  current_.untyped.push_back({index, literal, place});
}

void CodeBuilder::join_untyped(PendingResult outer, std::size_t operation_index, SourcePlace place) {
  std::move(outer.untyped.begin(), outer.untyped.end(), std::back_inserter(current_.untyped));
  current_.untyped.push_back({operation_index, std::nullopt, place});
}

}  // namespace emulator_models::soft_plc
