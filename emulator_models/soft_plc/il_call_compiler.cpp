// Calls of functions and function blocks: the part of il_instruction_compiler.hpp that knows their parameters.

#include <algorithm>
#include <utility>

#include "emulator_models/soft_plc/il_failure.hpp"
#include "emulator_models/soft_plc/il_instruction_compiler.hpp"

namespace emulator_models::soft_plc {
namespace {

using State = CurrentResult::State;

constexpr std::uint32_t kept_cr_slot = 0;  // calls of blocks do not stand in parentheses: no slot is in use

constexpr std::size_t formal_arguments_max = 16;  ///< each is looked for among all

Instruction call_of(InstancePlace instance) noexcept {
  return {Opcode::call_block, Area::variables, static_cast<std::uint8_t>(instance.kind), {}, instance.offset};
}

std::string listed(std::span<const std::string_view> names) {
  std::string list;
  for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string{name};
  return list;
}

}  // namespace

InstancePlace InstructionCompiler::instance_of(const Operand& operand) const {
  const Symbol* const symbol = find(operand);
  if (symbol == nullptr || !is_instance(operand))
    fail(operand.place, operand.text + " is no instance of a function block: declare it as `" + operand.text +
                            " : TON;` or the like");
  return std::get<InstancePlace>(*symbol);
}

void InstructionCompiler::call_block(const Statement& statement, const std::string& condition) {
  if (!deferred_.empty())
    fail(statement.place, "a function block cannot be called within a parenthesis: close it first");
  if (statement.operands.empty()) fail(statement.place, statement.operation + " takes a function block");
  const InstancePlace instance = instance_of(statement.operands.front());
  const bool conditional = !condition.empty();
  if (conditional) builder_.require_type(ElementaryType::boolean, statement.place, statement.operation);
  const std::size_t skip = conditional ? emit_skip(condition, statement.place) : 0;
  const bool has_arguments = statement.operands.size() > 1 || !statement.arguments.empty();
  if (has_arguments) {
    call_with_arguments(statement, instance);
  } else {
    builder_.emit(call_of(instance), statement.place);
  }
  if (conditional) builder_.point_to_next(skip);
  builder_.mark_call();
}

void InstructionCompiler::call_with_arguments(const Statement& statement, InstancePlace instance) {
  const std::string block{name_of(instance.kind)};
  builder_.emit({Opcode::defer, {}, 0, {}, kept_cr_slot}, statement.place);
  PendingResult kept = builder_.take();

  const auto pass_in = [&](const BlockParameter& parameter, const Operand& operand) {
    load_operand(operand);
    store_to(place_in(instance, parameter), std::string{parameter.name}, false, operand.place);
  };
  const std::span<const BlockParameter> parameters = parameters_of(instance.kind);
  for (std::size_t i = 1; i < statement.operands.size(); ++i) {
    const Operand& operand = statement.operands[i];
    if (i > parameters.size() || !parameters[i - 1].is_input)
      fail(operand.place, block + " has only " + std::to_string(i - 1) + " inputs");
    pass_in(parameters[i - 1], operand);
  }
  for (const NamedArgument& argument : statement.arguments) {
    const BlockParameter* const parameter = parameter_of(instance.kind, argument.name);
    if (parameter == nullptr || parameter->is_input == argument.is_output)
      fail(argument.place, block + " has no " + (argument.is_output ? "output " : "input ") + argument.name +
                               ": inputs are set with :=, outputs read with =>");
    if (!argument.is_output) pass_in(*parameter, argument.operand);
  }
  builder_.emit(call_of(instance), statement.place);
  for (const NamedArgument& argument : statement.arguments) {
    if (!argument.is_output) continue;
    if (argument.operand.kind == Operand::Kind::literal)
      fail(argument.operand.place, "an output is stored into a variable, not into a literal");
    builder_.load(place_in(instance, *parameter_of(instance.kind, argument.name)), argument.place);
    store_to(value_of(argument.operand), argument.operand.text, false, argument.operand.place);
  }
  builder_.put_back(std::move(kept));
  builder_.emit({Opcode::restore, {}, 0, {}, kept_cr_slot}, statement.place);
}

void InstructionCompiler::input_operator(const Statement& statement) {
  if (!deferred_.empty())
    fail(statement.place, "a function block cannot be called within a parenthesis: close it first");
  expect_operands(statement, 1);
  const InstancePlace instance = instance_of(statement.operands.front());
  const BlockParameter* const parameter = parameter_of(instance.kind, statement.operation);
  if (parameter == nullptr || !parameter->is_input)
    fail(statement.place, std::string{name_of(instance.kind)} + " has no input " + statement.operation);
  store_to(place_in(instance, *parameter), statement.operation, false, statement.place);
  builder_.emit(call_of(instance), statement.place);
  builder_.mark_call();
}

void InstructionCompiler::call_function(const Statement& statement, const IlFunction& function) {
  std::vector<Operand> rest = statement.operands;
  if (!statement.arguments.empty()) {
    rest = formal_arguments(statement, function);
    load_operand(rest.front());
    rest.erase(rest.begin());
  }
  builder_.require_cr(statement.place);
  const std::size_t needed = function.parameters.size() - 1;
  if (rest.size() < needed || (rest.size() > needed && !function.extensible))
    fail(statement.place, statement.operation + " has the parameters " + listed(function.parameters) +
                              ": the first is the CR, the others follow the name, separated by commas");
  apply_function(function, rest, statement);
}

std::vector<Operand> InstructionCompiler::formal_arguments(const Statement& statement,
                                                           const IlFunction& function) const {
  if (statement.arguments.size() > formal_arguments_max)
    fail(statement.place, "a function takes at most " + std::to_string(formal_arguments_max) +
                              " named parameters: call it twice");
  const std::size_t count =
      std::max(function.parameters.size(), function.extensible ? statement.arguments.size() : 0);
  std::vector<const NamedArgument*> given(count);
  for (const NamedArgument& argument : statement.arguments) {
    std::size_t index = 0;
    const auto name_at = [&](std::size_t i) {
      return i < function.parameters.size() ? std::string{function.parameters[i]}
                                            : "IN" + std::to_string(i + 1);
    };
    while (index < count && name_at(index) != argument.name) ++index;
    if (index == count || argument.is_output)
      fail(argument.place, statement.operation + " has no parameter " + argument.name + ": it has " +
                               listed(function.parameters));
    if (std::exchange(given[index], &argument) != nullptr)
      fail(argument.place, argument.name + " is given twice");
  }
  std::vector<Operand> arguments;
  for (const NamedArgument* const argument : given) {
    if (argument == nullptr)
      fail(statement.place,
           statement.operation + " needs all its parameters: " + listed(function.parameters));
    arguments.push_back(argument->operand);
  }
  return arguments;
}

void InstructionCompiler::apply_function(const IlFunction& function, std::span<const Operand> rest,
                                         const Statement& statement) {
  using Kind = IlFunction::Kind;
  const auto fold = [&](Operation operation, std::span<const Operand> operands) {
    for (const Operand& operand : operands) operate_with(operation, false, operand, statement);
  };
  switch (function.kind) {
    case Kind::convert:
      builder_.require_type(function.from, statement.place, statement.operation);
      builder_.emit({Opcode::convert, {}, static_cast<std::uint8_t>(function.from), function.to, 0},
                    statement.place);
      return builder_.set_type(function.to);
    case Kind::absolute: {
      const CurrentResult cr = builder_.cr();
      if (cr.state == State::untyped || !is_number(cr.type))
        fail(statement.place, "ABS takes a number that has a type");
      builder_.emit({Opcode::absolute, {}, 0, cr.type, 0}, statement.place);
      return;
    }
    case Kind::minimum:
      return fold(Operation::minimum, rest);
    case Kind::maximum:
      return fold(Operation::maximum, rest);
    case Kind::limit:  // MIN(MAX(MN, IN), MX)
      fold(Operation::maximum, rest.first(1));
      return fold(Operation::minimum, rest.last(1));
    case Kind::select:
      return select(rest, statement);
    case Kind::shift_left:
      return shift(ShiftKind::left, rest.front(), statement);
    case Kind::shift_right:
      return shift(ShiftKind::right, rest.front(), statement);
    case Kind::rotate_left:
      return shift(ShiftKind::rotate_left, rest.front(), statement);
    case Kind::rotate_right:
      return shift(ShiftKind::rotate_right, rest.front(), statement);
  }
}

/// IN1 when CR is TRUE, else IN0.
void InstructionCompiler::select(std::span<const Operand> choices, const Statement& statement) {
  builder_.require_type(ElementaryType::boolean, statement.place, statement.operation);
  const std::size_t to_second = builder_.emit({Opcode::jump_if, {}, 0, {}, 0}, statement.place);
  load_operand(choices[0]);
  PendingResult first = builder_.take();
  const std::size_t to_end = builder_.emit({Opcode::jump, {}, 0, {}, 0}, statement.place);
  builder_.point_to_next(to_second);
  load_operand(choices[1]);
  builder_.point_to_next(to_end);
  builder_.unify(first, choices[1].place, "SEL " + choices[0].text);
  if (builder_.cr().state == State::untyped)
    fail(statement.place, "neither literal has a type here: write INT#5 or another type");
}

void InstructionCompiler::shift(ShiftKind kind, const Operand& count, const Statement& statement) {
  const CurrentResult cr = builder_.cr();
  const bool shiftable = cr.state == State::typed && is_bits(cr.type) && cr.type != ElementaryType::boolean;
  if (!shiftable)
    fail(statement.place, statement.operation + " takes BYTE, WORD, DWORD or LWORD: convert with a function");
  ValuePlace by;
  if (count.kind == Operand::Kind::literal) {
    const auto literal = parse_literal(count.text);
    const bool typed = literal && literal->type;
    const ElementaryType type = typed ? *literal->type : ElementaryType::uint;
    by = builder_.constant(type, literal_value(count.text, type, count.place));
  } else {
    by = value_of(count);
  }
  if (!is_integer(by.type))
    fail(count.place, "the number of bits is an integer, not " + std::string{name_of(by.type)});
  const unsigned detail = static_cast<unsigned>(kind) + 4U * static_cast<unsigned>(cr.type);
  builder_.emit(Opcode::shift, by, statement.place, static_cast<std::uint8_t>(detail));
}

}  // namespace emulator_models::soft_plc
