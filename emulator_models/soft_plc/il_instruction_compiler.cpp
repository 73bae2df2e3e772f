#include "emulator_models/soft_plc/il_instruction_compiler.hpp"

#include <array>
#include <optional>
#include <utility>

#include "emulator_models/soft_plc/il_failure.hpp"
#include "emulator_models/soft_plc/il_parser.hpp"

namespace emulator_models::soft_plc {
namespace {

using State = CurrentResult::State;

ElementaryType result_type(Operation operation, ElementaryType operands) noexcept {
  return is_comparison(operation) ? ElementaryType::boolean : operands;
}

/// "C" of JMPC, "CN" of CALCN, "" of RET; nothing when it is another operator.
std::optional<std::string> condition_of(const std::string& operation, std::string_view stem) {
  if (!operation.starts_with(stem)) return std::nullopt;
  std::string condition = operation.substr(stem.size());
  if (!condition.empty() && condition != "C" && condition != "CN") return std::nullopt;
  return condition;
}

bool is_zero(const Operand& operand) {
  if (operand.kind != Operand::Kind::literal) return false;
  const auto literal = parse_literal(operand.text);
  if (!literal) return false;
  return literal->kind == Literal::Kind::real
             ? literal->real == 0.0
             : literal->kind == Literal::Kind::integer && literal->magnitude == 0;
}

}  // namespace

InstructionCompiler::InstructionCompiler(IlProgram& program, const SymbolTable& symbols,
                                         const SyntaxTree& tree, const AddressMap& map)
    : program_{program},
      map_{map},
      symbols_{symbols},
      tree_{tree},
      builder_{program},
      labels_{tree.statements} {}

void InstructionCompiler::run() {
  int passes = 0;
  do {
    if (++passes > passes_max) labels_.forget_current_results();
    pass();
  } while (labels_.changed_in_this_pass());
  last_pass_ = true;
  pass();
}

void InstructionCompiler::pass() {
  builder_.begin_pass();
  labels_.begin_pass();
  returns_.clear();
  deferred_.clear();
  for (const Statement& statement : tree_.statements) {
    if (!statement.label.empty()) {
      if (!deferred_.empty())
        fail(statement.label_place, "a label within a parenthesis could only be jumped into: close it first");
      builder_.set_cr(labels_.arrive(statement.label, builder_.cr(), builder_.next_index()));
    }
    if (!statement.operation.empty()) compile(statement);
  }
  if (!deferred_.empty())
    fail(deferred_.back().place, "this parenthesis is not closed: ) is missing on a line of its own");
  for (const std::size_t jump : returns_) builder_.point_to_next(jump);
  const SourcePlace end = tree_.statements.empty() ? SourcePlace{} : tree_.statements.back().place;
  builder_.emit({}, end);
  labels_.resolve(program_.code);
}

/// Until the last pass, lines that nothing is known to lead to wait for a label that does.
bool InstructionCompiler::is_dead(const Statement& statement) const {
  if (last_pass_ || builder_.cr().state != State::unreached) return false;
  const std::string& op = statement.operation;
  const bool formal_function = !statement.arguments.empty() && !op.starts_with("CAL");
  const bool works_without_cr = op == "LD" || op == "LDN" || op == "JMP" || op == "CAL" || op == "RET" ||
                                op == ")" || statement.opens_parenthesis || formal_function;
  return !works_without_cr;
}

void InstructionCompiler::compile(const Statement& statement) {
  if (is_dead(statement)) return;
  const std::string& op = statement.operation;
  if (op == ")") return close_parenthesis(statement);
  if (op == "LD" || op == "LDN") return load(statement, op == "LDN");
  if (op == "ST" || op == "STN") return store(statement, op == "STN");
  if (op == "NOT") return negate(statement);
  if (const NamedOperation* const found = find_operation(op)) {
    if (statement.opens_parenthesis) return open_parenthesis(statement, found->operation, found->negated);
    return operate(statement, found->operation, found->negated);
  }
  if (const auto condition = condition_of(op, "JMP")) return jump(statement, *condition);
  if (const auto condition = condition_of(op, "CAL")) return call_block(statement, *condition);
  if (const auto condition = condition_of(op, "RET")) return return_from(statement, *condition);
  const bool on_instance = statement.operands.size() == 1 && is_instance(statement.operands.front());
  if (is_input_operator(op) && (on_instance || (op != "S" && op != "R"))) return input_operator(statement);
  if (op == "S" || op == "R") return set_or_reset(statement);
  if (const auto function = find_function(op)) return call_function(statement, *function);
  if (op.size() > 1 && op.ends_with('N') &&
      (find_operation(op.substr(0, op.size() - 1)) != nullptr || op == "NOTN" || op == "SN" || op == "RN"))
    fail(statement.place, op + " does not exist: N negates the operand of LD, ST, AND, OR and XOR only");
  fail(statement.place, op + " is no operator, function or input of a function block of instruction list");
}

void InstructionCompiler::expect_operands(const Statement& statement, std::size_t count) const {
  if (!statement.arguments.empty()) fail(statement.place, statement.operation + " takes no named parameters");
  if (statement.operands.size() == count) return;
  const SourcePlace place =
      statement.operands.size() > count ? statement.operands[count].place : statement.place;
  fail(place,
       statement.operation + (count == 0 ? " takes no operand: it works on the CR" : " takes one operand"));
}

void InstructionCompiler::load(const Statement& statement, bool negated) {
  expect_operands(statement, 1);
  const Operand& operand = statement.operands.front();
  if (!negated) return load_operand(operand);
  ValuePlace value;
  if (operand.kind == Operand::Kind::literal) {
    const auto literal = parse_literal(operand.text);
    if (literal && !literal->type)
      fail(operand.place,
           "LDN needs the type of its literal: write BOOL#" + operand.text + " or WORD#" + operand.text);
    const ElementaryType type = literal ? *literal->type : ElementaryType::boolean;
    value = builder_.constant(type, literal_value(operand.text, type, operand.place));
  } else {
    value = value_of(operand);
  }
  if (!is_bits(value.type))
    fail(statement.place, "LDN negates BOOL and bit strings, not " + std::string{name_of(value.type)});
  builder_.emit(value.type == ElementaryType::boolean ? Opcode::load_bit_not : Opcode::load_not, value,
                statement.place);
  builder_.set_type(value.type);
}

void InstructionCompiler::load_operand(const Operand& operand) {
  if (operand.kind == Operand::Kind::literal) {
    builder_.load_literal(operand.text, operand.place);
  } else {
    builder_.load(value_of(operand), operand.place);
  }
}

void InstructionCompiler::store(const Statement& statement, bool negated) {
  expect_operands(statement, 1);
  const Operand& operand = statement.operands.front();
  if (operand.kind == Operand::Kind::literal)
    fail(operand.place, "a literal cannot be stored into: name a variable");
  const std::string name = operand.member.empty() ? operand.text : operand.text + "." + operand.member;
  store_to(value_of(operand), name, negated, statement.place);
}

void InstructionCompiler::store_to(const ValuePlace& target, const std::string& name, bool negated,
                                   SourcePlace place) {
  if (!target.read_only_as.empty())
    fail(place, name + " is " + std::string{target.read_only_as} + " and cannot be written by the program");
  builder_.require_type(target.type, place, name);
  if (negated && !is_bits(target.type))
    fail(place, "STN negates BOOL and bit strings, not " + std::string{name_of(target.type)});
  if (target.type == ElementaryType::boolean) {
    builder_.emit(negated ? Opcode::store_bit_not : Opcode::store_bit, target, place);
  } else {
    builder_.emit(negated ? Opcode::store_not : Opcode::store, target, place);
  }
}

void InstructionCompiler::set_or_reset(const Statement& statement) {
  expect_operands(statement, 1);
  const Operand& operand = statement.operands.front();
  if (operand.kind == Operand::Kind::literal) fail(operand.place, "a literal cannot be set: name a BOOL");
  const ValuePlace target = value_of(operand);
  if (target.type != ElementaryType::boolean)
    fail(operand.place, "S and R set and clear a BOOL, not " + std::string{name_of(target.type)});
  if (!target.read_only_as.empty())
    fail(statement.place,
         operand.text + " is " + std::string{target.read_only_as} + " and cannot be written by the program");
  builder_.require_type(ElementaryType::boolean, statement.place, statement.operation);
  builder_.emit(statement.operation == "S" ? Opcode::set_bit : Opcode::reset_bit, target, statement.place);
}

void InstructionCompiler::negate(const Statement& statement) {
  expect_operands(statement, 0);
  builder_.require_cr(statement.place);
  if (builder_.cr().state == State::untyped)
    fail(statement.place, "NOT needs a type: write LD BOOL#1 or LD WORD#16#FF before it");
  const ElementaryType type = builder_.cr().type;
  if (!is_bits(type))
    fail(statement.place, "NOT takes BOOL or bit strings, CR is " + std::string{name_of(type)});
  builder_.emit({type == ElementaryType::boolean ? Opcode::not_bit : Opcode::complement, {}, 0, type, 0},
                statement.place);
}

void InstructionCompiler::operate(const Statement& statement, Operation operation, bool negated) {
  expect_operands(statement, 1);
  operate_with(operation, negated, statement.operands.front(), statement);
}

void InstructionCompiler::operate_with(Operation operation, bool negated, const Operand& operand,
                                       const Statement& statement) {
  const SourcePlace place = statement.place;
  builder_.require_cr(place);
  if ((operation == Operation::div || operation == Operation::mod) && is_zero(operand))
    fail(operand.place, "division by a literal zero: it would stop the PLC in every scan");
  ValuePlace right;
  if (operand.kind != Operand::Kind::literal) {
    right = value_of(operand);
  } else {
    const auto literal = parse_literal(operand.text);
    if (!literal) fail(operand.place, operand.text + ": " + literal.error());
    const bool typed = builder_.cr().state == State::typed;
    if (!typed && !literal->type) {
      if (is_comparison(operation) || negated)
        fail(operand.place,
             "neither literal has a type here: write INT#" + operand.text + " or another type");
      return builder_.operate_untyped(operation, operand.text, operand.place);
    }
    const ElementaryType type = typed ? builder_.cr().type : *literal->type;
    right = builder_.constant(type, literal_value(operand.text, type, operand.place));
  }
  builder_.require_type(right.type, place, statement.operation + " " + operand.text);
  check_has_operation(operation, right.type, place);
  emit_operation(operation, negated, right, place);
  builder_.set_type(result_type(operation, right.type));
}

void InstructionCompiler::emit_operation(Operation operation, bool negated, const ValuePlace& right,
                                         SourcePlace place) {
  if (right.type == ElementaryType::boolean) return emit_bit_operation(operation, negated, right, place);
  builder_.emit(negated ? Opcode::operate_not : Opcode::operate, right, place,
                static_cast<std::uint8_t>(operation));
}

/// FALSE < TRUE, so the comparisons of BOOL are bit operations, too: a > b is a AND NOT b.
void InstructionCompiler::emit_bit_operation(Operation operation, bool negated, const ValuePlace& right,
                                             SourcePlace place) {
  const auto emit = [&](Opcode opcode) { builder_.emit(opcode, right, place); };
  const auto negate_cr = [&] { builder_.emit({Opcode::not_bit, {}, 0, ElementaryType::boolean, 0}, place); };
  switch (operation) {
    case Operation::bit_and:
      return emit(negated ? Opcode::and_bit_not : Opcode::and_bit);
    case Operation::bit_or:
      return emit(negated ? Opcode::or_bit_not : Opcode::or_bit);
    case Operation::bit_xor:
      return emit(negated ? Opcode::xor_bit_not : Opcode::xor_bit);
    case Operation::greater:
      return emit(Opcode::and_bit_not);
    case Operation::greater_equal:
      return emit(Opcode::or_bit_not);
    case Operation::equal:
      return emit(Opcode::xor_bit_not);
    case Operation::not_equal:
      return emit(Opcode::xor_bit);
    case Operation::less_equal:
      negate_cr();
      return emit(Opcode::or_bit);
    case Operation::less:
      negate_cr();
      return emit(Opcode::and_bit);
    default:
      fail(place, "BOOL has no arithmetic");
  }
}

void InstructionCompiler::open_parenthesis(const Statement& statement, Operation operation, bool negated) {
  if (deferred_.size() == nesting_max)
    fail(statement.place, "parentheses nest at most " + std::to_string(nesting_max) + " deep");
  const bool dead = !last_pass_ && builder_.cr().state == State::unreached;
  if (!dead) builder_.require_cr(statement.place);
  const auto slot = static_cast<std::uint32_t>(deferred_.size());
  builder_.emit({Opcode::defer, {}, 0, ElementaryType::boolean, slot}, statement.place);
  deferred_.push_back({operation, negated, builder_.take(), statement.place});
  if (statement.operands.empty()) return;
  load_operand(statement.operands.front());
}

void InstructionCompiler::close_parenthesis(const Statement& statement) {
  if (deferred_.empty()) fail(statement.place, "there is no parenthesis to close here");
  Deferred deferred = std::move(deferred_.back());
  deferred_.pop_back();
  const std::size_t slot = deferred_.size();
  if (deferred.outer.cr.state == State::unreached) return builder_.put_back(std::move(deferred.outer));

  builder_.require_cr(statement.place);
  builder_.unify(deferred.outer, statement.place, "the operation before the parenthesis");
  if (builder_.cr().state == State::untyped) {
    if (is_comparison(deferred.operation) || deferred.negated)
      fail(statement.place, "no literal has a type here: write INT#5 or another type");
    const std::size_t index = builder_.emit({Opcode::operate_deferred,
                                             {},
                                             static_cast<std::uint8_t>(deferred.operation),
                                             ElementaryType::lint,
                                             static_cast<std::uint32_t>(slot)},
                                            deferred.place);
    return builder_.join_untyped(std::move(deferred.outer), index, deferred.place);
  }
  const ElementaryType type = builder_.cr().type;
  check_has_operation(deferred.operation, type, deferred.place);
  emit_deferred_operation(deferred, type, slot);
  builder_.set_type(result_type(deferred.operation, type));
}

void InstructionCompiler::emit_deferred_operation(const Deferred& deferred, ElementaryType type,
                                                  std::size_t slot) {
  constexpr std::array<std::array<Opcode, 2>, 3> bit_opcodes{
      {{Opcode::and_bit_deferred, Opcode::and_bit_not_deferred},
       {Opcode::or_bit_deferred, Opcode::or_bit_not_deferred},
       {Opcode::xor_bit_deferred, Opcode::xor_bit_not_deferred}}};
  const auto operation = static_cast<std::uint8_t>(deferred.operation);
  const bool on_bits = type == ElementaryType::boolean && deferred.operation <= Operation::bit_xor;
  Opcode opcode = deferred.negated ? Opcode::operate_not_deferred : Opcode::operate_deferred;
  if (on_bits) opcode = bit_opcodes[operation][deferred.negated ? 1 : 0];
  builder_.emit({opcode, {}, operation, type, static_cast<std::uint32_t>(slot)}, deferred.place);
}

std::size_t InstructionCompiler::emit_skip(const std::string& condition, SourcePlace place) {
  return builder_.emit({condition == "C" ? Opcode::jump_if_not : Opcode::jump_if, {}, 0, {}, 0}, place);
}

std::size_t InstructionCompiler::emit_jump(const Statement& statement, const std::string& condition) {
  Opcode opcode = Opcode::jump;
  if (!condition.empty()) {
    builder_.require_type(ElementaryType::boolean, statement.place, statement.operation);
    opcode = condition == "C" ? Opcode::jump_if : Opcode::jump_if_not;
  }
  return builder_.emit({opcode, {}, 0, {}, 0}, statement.place);
}

void InstructionCompiler::jump(const Statement& statement, const std::string& condition) {
  if (!deferred_.empty()) fail(statement.place, "a jump must not leave a parenthesis: close it first");
  expect_operands(statement, 1);
  const Operand& target = statement.operands.front();
  if (target.kind != Operand::Kind::name || !target.member.empty())
    fail(target.place, statement.operation + " takes a label");
  const std::size_t index = emit_jump(statement, condition);
  labels_.jump(target.text, target.place, builder_.cr(), index);
  if (condition.empty()) builder_.set_cr({});
}

void InstructionCompiler::return_from(const Statement& statement, const std::string& condition) {
  if (!deferred_.empty()) fail(statement.place, "a return must not leave a parenthesis: close it first");
  expect_operands(statement, 0);
  returns_.push_back(emit_jump(statement, condition));
  if (condition.empty()) builder_.set_cr({});
}

const Symbol* InstructionCompiler::find(const Operand& operand) const {
  const auto found = operand.kind == Operand::Kind::name ? symbols_.find(operand.text) : symbols_.end();
  return found == symbols_.end() ? nullptr : &found->second;
}

bool InstructionCompiler::is_instance(const Operand& operand) const {
  const Symbol* const symbol = find(operand);
  return symbol != nullptr && operand.member.empty() && std::holds_alternative<InstancePlace>(*symbol);
}

ValuePlace InstructionCompiler::value_of(const Operand& operand) {
  if (operand.kind == Operand::Kind::direct_address)
    return place_of_address(operand.text, operand.place, map_, program_);
  const Symbol* const symbol = find(operand);
  if (symbol == nullptr) fail(operand.place, operand.text + " is not declared: add it to a VAR block");
  if (const auto* const value = std::get_if<ValuePlace>(symbol)) {
    if (!operand.member.empty())
      fail(operand.place, operand.text + " is no function block and has no " + operand.member);
    return *value;
  }
  const InstancePlace instance = std::get<InstancePlace>(*symbol);
  const std::string block{name_of(instance.kind)};
  if (operand.member.empty())
    fail(operand.place, operand.text + " is a " + block + ": name one of its values, as in " + operand.text +
                            "." + std::string{parameters_of(instance.kind).back().name});
  const BlockParameter* const parameter = parameter_of(instance.kind, operand.member);
  if (parameter == nullptr) fail(operand.place, block + " has no input or output " + operand.member);
  return place_in(instance, *parameter);
}

}  // namespace emulator_models::soft_plc
