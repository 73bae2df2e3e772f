#include "property_tests/emulator_models/soft_plc/generated_program.hpp"

#include <array>

#include <fmt/format.h>

namespace property_tests {
namespace {

using emulator_models::soft_plc::is_bits;
using emulator_models::soft_plc::is_integer;
using emulator_models::soft_plc::is_signed_integer;
using emulator_models::soft_plc::name_of;
using emulator_models::soft_plc::size_bytes;

constexpr std::array types{ElementaryType::boolean, ElementaryType::int_, ElementaryType::dint,
                           ElementaryType::word,    ElementaryType::sint, ElementaryType::lint,
                           ElementaryType::usint,   ElementaryType::uint, ElementaryType::udint,
                           ElementaryType::ulint,   ElementaryType::byte, ElementaryType::dword,
                           ElementaryType::lword,   ElementaryType::time};
constexpr std::size_t integer_types_and_bits = 13;  // all but TIME, which stands last
constexpr std::size_t variables_of_type = 3;
constexpr unsigned depth_max = 4;
constexpr std::int64_t ns_per_ms = 1'000'000;

std::string variable_name(ElementaryType type, std::size_t number) {
  return fmt::format("N_{}_{}", name_of(type), number + 1);
}

std::string counter_name(unsigned depth) { return fmt::format("K_{}", depth); }

class Generator {
 public:
  explicit Generator(Tape& tape) : tape_{tape} {}

  std::vector<Statement> statements(unsigned depth, std::size_t count_max) {
    std::vector<Statement> made;
    while (made.size() < count_max && !tape_.is_at_end()) made.push_back(statement(depth));
    return made;
  }

 private:
  ElementaryType any_type() { return types[tape_.choose(types.size())]; }

  Expression variable(ElementaryType type) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < variables_of_type; ++i) names.push_back(variable_name(type, i));
    if (type == ElementaryType::boolean)
      for (const char* name : {"T1.Q", "C1.Q", "E1.Q", "L1.Q1"}) names.emplace_back(name);
    if (type == ElementaryType::int_) names.emplace_back("C1.CV");
    if (type == ElementaryType::time) names.emplace_back("T1.ET");
    Expression leaf;
    leaf.kind = Expression::Kind::variable;
    leaf.type = type;
    leaf.word = names[tape_.choose(names.size())];
    return leaf;
  }

  /// The ends of the type's range as often as small numbers.
  Expression literal(ElementaryType type) {
    Expression leaf;
    leaf.type = type;
    if (type == ElementaryType::boolean) {
      leaf.value = tape_.flip() ? 1 : 0;
    } else if (type == ElementaryType::time) {
      leaf.value = static_cast<Wide>(tape_.choose(40)) * ns_per_ms;
    } else {
      const auto bits = static_cast<unsigned>(8 * size_bytes(type));
      const Wide end = Wide{1} << (is_signed_integer(type) ? bits - 1 : bits);
      const Wide least = is_signed_integer(type) ? -end : 0;
      const auto near = static_cast<Wide>(tape_.choose(6));
      const std::size_t where = tape_.choose(4);
      leaf.value = where == 1 ? end - 1 - near : where == 2 ? least + near : near;
      if (where == 3 && is_signed_integer(type)) leaf.value = -near;
    }
    return leaf;
  }

  Expression leaf(ElementaryType type) { return tape_.choose(3) == 2 ? literal(type) : variable(type); }

  Expression with_parts(Expression::Kind kind, ElementaryType type, std::string word,
                        std::vector<Expression> parts) {
    Expression made;
    made.kind = kind;
    made.type = type;
    made.word = std::move(word);
    made.parts = std::move(parts);
    return made;
  }

  Expression operation_of(ElementaryType type, ElementaryType operands, const char* operation,
                          unsigned depth) {
    std::vector<Expression> parts{expression(operands, depth + 1), expression(operands, depth + 1)};
    const std::string word = operation;
    if ((word == "DIV" || word == "MOD") && parts[1].kind == Expression::Kind::literal && parts[1].value == 0)
      parts[1].value = 1;  // a literal zero is refused
    Expression made = with_parts(Expression::Kind::binary, type, word, std::move(parts));
    made.short_form = tape_.flip();
    return made;
  }

  template <std::size_t Count>
  const char* one_of(const char* const (&words)[Count]) {
    return words[tape_.choose(Count)];
  }

  Expression expression(ElementaryType type, unsigned depth) {
    using enum Expression::Kind;
    if (depth >= depth_max || tape_.choose(3) == 0) return leaf(type);
    const std::size_t way = tape_.choose(8);
    if (type == ElementaryType::boolean && way >= 5)
      return operation_of(type, any_type(), one_of({"GT", "GE", "EQ", "NE", "LE", "LT"}), depth);
    if (way == 4)
      return with_parts(select, type, "SEL",
                        {expression(ElementaryType::boolean, depth + 1), leaf(type), leaf(type)});
    if (type == ElementaryType::time) return operation_of(type, type, one_of({"ADD", "SUB"}), depth);
    if (way == 3) return conversion(type, depth);
    if (is_bits(type)) {
      if (way == 0) return with_parts(complement, type, "NOT", {expression(type, depth + 1)});
      if (way == 1 && type != ElementaryType::boolean)
        return with_parts(
            shift, type, one_of({"SHL", "SHR", "ROL", "ROR"}),
            {expression(type, depth + 1), leaf(tape_.flip() ? ElementaryType::int_ : ElementaryType::usint)});
      return operation_of(type, type, one_of({"AND", "OR", "XOR", "ANDN", "ORN", "XORN"}), depth);
    }
    if (way == 0) return with_parts(absolute, type, "ABS", {expression(type, depth + 1)});
    if (way == 1)
      return with_parts(extreme, type, one_of({"MIN", "MAX"}),
                        {expression(type, depth + 1), leaf(type), leaf(type)});
    if (way == 2)
      return with_parts(limit, type, "LIMIT", {expression(type, depth + 1), leaf(type), leaf(type)});
    return operation_of(type, type, one_of({"ADD", "SUB", "MUL", "DIV", "MOD"}), depth);
  }

  Expression conversion(ElementaryType type, unsigned depth) {
    ElementaryType from = types[tape_.choose(integer_types_and_bits)];
    if (from == type) from = type == ElementaryType::dint ? ElementaryType::int_ : ElementaryType::dint;
    if (type == ElementaryType::lint && tape_.flip()) from = ElementaryType::time;
    return with_parts(Expression::Kind::convert, type, fmt::format("{}_TO_{}", name_of(from), name_of(type)),
                      {expression(from, depth + 1)});
  }

  Statement store() {
    const ElementaryType type = any_type();
    Statement made;
    const std::size_t way = tape_.choose(6);
    using enum Statement::Kind;
    if (way == 4 && is_bits(type)) made.kind = store_not;
    if (way == 5 && type == ElementaryType::boolean) made.kind = tape_.flip() ? set : reset;
    made.target = variable_name(type, tape_.choose(variables_of_type));
    made.operands.push_back(expression(type, 0));
    return made;
  }

  Statement call() {
    using enum ElementaryType;
    Statement made;
    made.kind = std::array{Statement::Kind::call_ton, Statement::Kind::call_ctu, Statement::Kind::call_r_trig,
                           Statement::Kind::call_sr}[tape_.choose(4)];
    made.operands.push_back(leaf(boolean));
    if (made.kind == Statement::Kind::call_ton) made.operands.push_back(leaf(time));
    if (made.kind == Statement::Kind::call_ctu || made.kind == Statement::Kind::call_sr)
      made.operands.push_back(leaf(boolean));
    if (made.kind == Statement::Kind::call_ctu) made.operands.push_back(leaf(int_));
    return made;
  }

  Statement statement(unsigned depth) {
    const std::size_t way = tape_.choose(10);
    if (way <= 5) return store();
    if (way <= 7) return call();
    Statement made;
    if (depth >= depth_max - 1) return store();
    if (way == 9) {
      made.kind = Statement::Kind::loop;
      made.target = counter_name(depth);
      made.times = 1 + static_cast<unsigned>(tape_.choose(3));
    } else {
      made.kind = std::array{Statement::Kind::if_true, Statement::Kind::if_false,
                             Statement::Kind::return_if}[tape_.choose(3)];
      made.operands.push_back(expression(ElementaryType::boolean, 0));
      if (made.kind == Statement::Kind::return_if) return made;
    }
    made.body = statements(depth + 1, 1 + tape_.choose(3));
    return made;
  }

  Tape& tape_;
};

class Writer {
 public:
  [[nodiscard]] std::string text() && { return std::move(text_); }

  void write(const std::vector<Statement>& statements) {
    for (const Statement& statement : statements) write(statement);
  }
  void line(std::string_view line_text) { text_.append(line_text) += '\n'; }

 private:
  [[nodiscard]] static std::string leaf_text(const Expression& leaf) {
    if (leaf.kind == Expression::Kind::variable) return leaf.word;
    if (leaf.type == ElementaryType::boolean) return leaf.value != 0 ? "TRUE" : "FALSE";
    if (leaf.type == ElementaryType::time)
      return fmt::format("T#{}ms", static_cast<std::int64_t>(leaf.value / ns_per_ms));
    if (leaf.value < 0)
      return fmt::format("{}#{}", name_of(leaf.type), static_cast<std::int64_t>(leaf.value));
    return fmt::format("{}#{}", name_of(leaf.type), static_cast<std::uint64_t>(leaf.value));
  }
  [[nodiscard]] static bool is_leaf(const Expression& expression) {
    return expression.kind == Expression::Kind::variable || expression.kind == Expression::Kind::literal;
  }

  /// Lines after which CR is the expression's value.
  void write(const Expression& expression) {
    if (is_leaf(expression)) return line("LD " + leaf_text(expression));
    if (expression.kind == Expression::Kind::complement &&
        expression.parts[0].kind == Expression::Kind::variable)
      return line("LDN " + leaf_text(expression.parts[0]));
    write(expression.parts[0]);
    if (expression.kind == Expression::Kind::binary && !is_leaf(expression.parts[1]))
      return parenthesis(expression);
    std::string text = expression.word;
    for (std::size_t i = 1; i < expression.parts.size(); ++i)
      text += (i == 1 ? " " : ", ") + leaf_text(expression.parts[i]);
    line(text);
  }

  void parenthesis(const Expression& expression) {
    Writer inner;
    inner.write(expression.parts[1]);
    std::string text = std::move(inner).text();
    constexpr std::string_view load = "LD ";
    const bool short_form = expression.short_form && text.starts_with(load);
    text_ += expression.word + (short_form ? "( " + text.substr(load.size()) : "(\n" + text) + ")\n";
  }

  void write(const Statement& statement) {
    using enum Statement::Kind;
    const auto operand = [&](std::size_t i) { return leaf_text(statement.operands[i]); };
    switch (statement.kind) {
      case store:
      case store_not:
      case set:
      case reset:
        write(statement.operands[0]);
        return line((statement.kind == store       ? "ST "
                     : statement.kind == store_not ? "STN "
                     : statement.kind == set       ? "S "
                                                   : "R ") +
                    statement.target);
      case return_if:
        write(statement.operands[0]);
        return line("RETC");
      case if_true:
      case if_false: {
        const std::string label = new_label();
        write(statement.operands[0]);
        line((statement.kind == if_true ? "JMPCN " : "JMPC ") + label);
        write(statement.body);
        return line(label + ":");
      }
      case loop: {
        const std::string label = new_label();
        line("LD USINT#0\nST " + statement.target + "\n" + label + ":");
        write(statement.body);
        return line(fmt::format("LD {0}\nADD USINT#1\nST {0}\nLT USINT#{1}\nJMPC {2}", statement.target,
                                statement.times, label));
      }
      case call_ton:
        return line(fmt::format("CAL T1(IN := {}, PT := {})", operand(0), operand(1)));
      case call_ctu:
        return line(fmt::format("CAL C1(CU := {}, R := {}, PV := {})", operand(0), operand(1), operand(2)));
      case call_r_trig:
        return line(fmt::format("CAL E1(CLK := {})", operand(0)));
      case call_sr:
        return line(fmt::format("CAL L1(S1 := {}, R := {})", operand(0), operand(1)));
    }
  }

  std::string new_label() { return fmt::format("L_{}", ++labels_count_); }

  std::string text_;
  unsigned labels_count_ = 0;
};

}  // namespace

std::size_t Tape::choose(std::size_t count) noexcept {
  if (bytes_.empty()) return 0;
  const std::size_t chosen = bytes_.front() % count;
  bytes_ = bytes_.subspan(1);
  return chosen;
}

GeneratedProgram program_of(Tape& tape) {
  constexpr std::size_t statements_max = 12;
  GeneratedProgram program;
  for (const ElementaryType type : types) {
    for (std::size_t i = 0; i < variables_of_type; ++i)
      program.variables.push_back({variable_name(type, i), type});
  }
  for (unsigned depth = 0; depth < depth_max; ++depth)
    program.variables.push_back({counter_name(depth), ElementaryType::usint});
  program.statements = Generator{tape}.statements(0, statements_max);
  return program;
}

std::string source_of(const GeneratedProgram& program) {
  Writer writer;
  writer.line("PROGRAM generated\nVAR");
  for (const auto& variable : program.variables)
    writer.line(fmt::format("  {} : {};", variable.name, name_of(variable.type)));
  writer.line("  T1 : TON; C1 : CTU; E1 : R_TRIG; L1 : SR;\nEND_VAR");
  writer.write(program.statements);
  writer.line("LD TRUE\nEND_PROGRAM");
  return std::move(writer).text();
}

}  // namespace property_tests
