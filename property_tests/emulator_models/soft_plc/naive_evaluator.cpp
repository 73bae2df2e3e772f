#include "property_tests/emulator_models/soft_plc/naive_evaluator.hpp"

#include <algorithm>

namespace property_tests {
namespace {

using emulator_models::soft_plc::FaultKind;

bool has_sign(ElementaryType type) {
  using enum ElementaryType;
  return type == sint || type == int_ || type == dint || type == lint || type == time;
}

unsigned bits_of_type(ElementaryType type) {
  using enum ElementaryType;
  switch (type) {
    case boolean:
      return 1;
    case sint:
    case usint:
    case byte:
      return 8;
    case int_:
    case uint:
    case word:
      return 16;
    case dint:
    case udint:
    case dword:
      return 32;
    default:
      return 64;
  }
}

Wide power_of_two(unsigned exponent) { return Wide{1} << exponent; }

__extension__ typedef unsigned __int128 UnsignedWide;

/// Low 128 bits: the product of two numbers of 64 bits can need all of them.
Wide product(Wide left, Wide right) {
  return static_cast<Wide>(static_cast<UnsignedWide>(left) * static_cast<UnsignedWide>(right));
}

bool compare(const std::string& operation, Wide left, Wide right) {
  if (operation == "GT") return left > right;
  if (operation == "GE") return left >= right;
  if (operation == "EQ") return left == right;
  if (operation == "NE") return left != right;
  if (operation == "LE") return left <= right;
  return left < right;
}

Wide apply(const std::string& operation, ElementaryType type, Wide left, Wide right) {
  const Wide mask = power_of_two(bits_of_type(type)) - 1;
  if (operation.starts_with("AND") || operation.starts_with("OR") || operation.starts_with("XOR")) {
    if (operation.ends_with('N')) right = mask - right;
    return operation[0] == 'A' ? left & right : operation[0] == 'O' ? left | right : left ^ right;
  }
  if (operation == "ADD") return cut_to(type, left + right);
  if (operation == "SUB") return cut_to(type, left - right);
  if (operation == "MUL") return cut_to(type, product(left, right));
  if (right == 0) throw FaultKind{FaultKind::division_by_zero};
  return cut_to(type, operation == "DIV" ? left / right : left % right);
}

bool is_comparison(const std::string& operation) { return operation.size() == 2 && operation != "OR"; }

Wide shifted(const std::string& operation, ElementaryType type, Wide value, Wide count) {
  if (count < 0) throw FaultKind{FaultKind::negative_shift};
  const unsigned width = bits_of_type(type);
  const bool rotates = operation.starts_with("RO");
  // Bit by bit: a bit that leaves comes back on the other side, or is gone.
  for (Wide i = 0; i < (rotates ? count % Wide{width} : std::min(count, Wide{width})); ++i) {
    if (operation.ends_with('L')) {
      const Wide leaves = value / power_of_two(width - 1);
      value = value * 2 % power_of_two(width) + (rotates ? leaves : 0);
    } else {
      const Wide leaves = value % 2;
      value = value / 2 + (rotates ? leaves * power_of_two(width - 1) : 0);
    }
  }
  return value;
}

}  // namespace

Wide cut_to(ElementaryType type, Wide number) {
  const Wide range = power_of_two(bits_of_type(type));
  Wide rest = number % range;
  if (rest < 0) rest += range;
  if (has_sign(type) && rest >= range / 2) rest -= range;
  return rest;
}

NaiveEvaluator::NaiveEvaluator(const GeneratedProgram& program) : program_{program} {}

std::optional<FaultKind> NaiveEvaluator::scan(std::int64_t now_ns) {
  now_ = now_ns;
  try {
    execute(program_.statements);
  } catch (const FaultKind kind) {
    return kind;
  }
  return std::nullopt;
}

Wide NaiveEvaluator::value_of(const Expression& expression) {
  using enum Expression::Kind;
  if (expression.kind == variable) return values[expression.word];
  if (expression.kind == literal) return expression.value;
  const Wide first = value_of(expression.parts[0]);
  const auto other = [&](std::size_t i) { return value_of(expression.parts[i]); };
  switch (expression.kind) {
    case complement:
      return power_of_two(bits_of_type(expression.type)) - 1 - first;
    case absolute:
      return cut_to(expression.type, first < 0 ? -first : first);
    case convert:
      if (expression.type == ElementaryType::boolean) return first != 0 ? 1 : 0;
      if (expression.parts[0].type == ElementaryType::time) return first / 1'000'000;
      return cut_to(expression.type, first);
    case extreme:
      return expression.word == "MIN" ? std::min({first, other(1), other(2)})
                                      : std::max({first, other(1), other(2)});
    case limit:
      return std::min(std::max(first, other(1)), other(2));
    case select:
      return first != 0 ? other(2) : other(1);
    case shift:
      return shifted(expression.word, expression.type, first, other(1));
    default:
      if (is_comparison(expression.word)) return compare(expression.word, first, other(1)) ? 1 : 0;
      return apply(expression.word, expression.type, first, other(1));
  }
}

bool NaiveEvaluator::execute(const std::vector<Statement>& statements) {
  return std::ranges::all_of(statements, [this](const Statement& statement) { return execute(statement); });
}

bool NaiveEvaluator::execute(const Statement& statement) {
  using enum Statement::Kind;
  const auto operand = [&](std::size_t i) { return value_of(statement.operands[i]); };
  switch (statement.kind) {
    case store:
      values[statement.target] = operand(0);
      return true;
    case store_not:
      values[statement.target] = power_of_two(bits_of_type(statement.operands[0].type)) - 1 - operand(0);
      return true;
    case set:
    case reset:
      if (operand(0) != 0) values[statement.target] = statement.kind == set ? 1 : 0;
      return true;
    case return_if:
      return operand(0) == 0;
    case if_true:
    case if_false:
      return (operand(0) != 0) == (statement.kind == if_true) ? execute(statement.body) : true;
    case loop:
      values[statement.target] = 0;
      for (unsigned i = 0; i < statement.times; ++i) {
        if (!execute(statement.body)) return false;
        values[statement.target] += 1;
      }
      return true;
    case call_ton:
      call_timer(operand(0) != 0, operand(1));
      return true;
    case call_ctu:
      call_counter(operand(0) != 0, operand(1) != 0, operand(2));
      return true;
    case call_r_trig: {
      const bool input = operand(0) != 0;
      values["E1.Q"] = input && !edge_input_ ? 1 : 0;
      edge_input_ = input;
      return true;
    }
    case call_sr: {
      const bool set_now = operand(0) != 0;
      const bool reset_now = operand(1) != 0;
      if (set_now || reset_now) values["L1.Q1"] = set_now ? 1 : 0;
      return true;
    }
  }
  return true;
}

void NaiveEvaluator::call_timer(bool in, Wide preset) {
  Wide& q = values["T1.Q"];
  if (!in) {
    timer_start_.reset();
    q = values["T1.ET"] = 0;
    return;
  }
  if (!timer_start_) timer_start_ = now_;
  if (q != 0) return;  // it has been done already, and stays so
  preset = std::max(preset, Wide{0});
  values["T1.ET"] = std::min(now_ - *timer_start_, preset);
  q = now_ - *timer_start_ >= preset ? 1 : 0;
}

void NaiveEvaluator::call_counter(bool up, bool reset, Wide preset) {
  Wide& count = values["C1.CV"];
  if (reset) {
    count = 0;
  } else if (up && !counter_input_ && count < 32767) {
    count += 1;
  }
  counter_input_ = up;
  values["C1.Q"] = count >= preset ? 1 : 0;
}

}  // namespace property_tests
