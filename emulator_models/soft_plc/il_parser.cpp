#include "emulator_models/soft_plc/il_parser.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "emulator_models/soft_plc/il_failure.hpp"
#include "emulator_models/soft_plc/il_lexer.hpp"
#include "emulator_models/soft_plc/il_operations.hpp"
#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {
namespace {

constexpr std::array<std::string_view, 14> other_operators{
    "LD", "LDN", "ST", "STN", "S", "R", "NOT", "JMP", "JMPC", "JMPCN", "CAL", "CALC", "CALCN", "RET"};
constexpr std::array<std::string_view, 19> keywords{
    "RETC",      "RETCN",      "TRUE",   "FALSE",    "PROGRAM", "END_PROGRAM", "VAR",
    "VAR_INPUT", "VAR_OUTPUT", "RETAIN", "CONSTANT", "AT",      "NON_RETAIN",  "END_VAR",
    "DATE",      "TOD",        "DT",     "STRING",   "WSTRING"};

bool contains(std::span<const std::string_view> names, std::string_view name) noexcept {
  return std::ranges::find(names, name) != names.end();
}

class Parser {
 public:
  explicit Parser(std::vector<Token> tokens) noexcept : tokens_{std::move(tokens)} {}

  SyntaxTree run() {
    skip_line_ends();
    expect_keyword("PROGRAM", "a source begins with PROGRAM and a name");
    tree_.program_name = take_name("a program");
    skip_line_ends();
    while (upper(peek().text).starts_with("VAR")) take_block();
    while (skip_line_ends(), !at_keyword("END_PROGRAM")) take_statement();
    next();
    skip_line_ends();
    if (peek().kind != TokenKind::end) fail_here("nothing follows END_PROGRAM: a source holds one program");
    return std::move(tree_);
  }

 private:
  [[noreturn]] void fail_here(std::string message) const { fail(peek().place, std::move(message)); }

  [[nodiscard]] const Token& peek() const noexcept { return tokens_[position_]; }
  Token next() noexcept {
    const Token token = tokens_[position_];
    if (token.kind != TokenKind::end) ++position_;
    return token;
  }
  [[nodiscard]] bool at(TokenKind kind) const noexcept { return peek().kind == kind; }
  [[nodiscard]] bool at_keyword(std::string_view word) const {
    return at(TokenKind::identifier) && upper(peek().text) == word;
  }
  bool skip(TokenKind kind) noexcept {
    const bool found = at(kind);
    if (found) next();
    return found;
  }
  bool skip_keyword(std::string_view word) {
    const bool found = at_keyword(word);
    if (found) next();
    return found;
  }
  void skip_line_ends() noexcept {
    while (skip(TokenKind::line_end)) {
    }
  }
  void expect(TokenKind kind, std::string_view message) {
    if (!skip(kind)) fail_here(std::string{message});
  }
  void expect_keyword(std::string_view word, std::string_view message) {
    if (!skip_keyword(word)) fail_here(std::string{message});
  }

  /// @param of_what  "a variable": for the message
  std::string take_name(std::string_view of_what) {
    if (!at(TokenKind::identifier))
      fail_here(std::string{of_what} + " needs a name: letters, digits and _, no digit first");
    const Token token = next();
    std::string name = upper(token.text);
    if (is_reserved(name))
      fail(token.place, std::string{token.text} + " is a word of the language and cannot be the name of " +
                            std::string{of_what} + ": choose another");
    return name;
  }

  void take_block() {
    const Token head = next();
    Declaration common;
    const std::string word = upper(head.text);
    if (word == "VAR_INPUT") {
      common.section = VariableSection::input;
    } else if (word == "VAR_OUTPUT") {
      common.section = VariableSection::output;
    } else if (word != "VAR") {
      fail(head.place, std::string{head.text} + " is unknown: use VAR, VAR_INPUT or VAR_OUTPUT");
    }
    if (skip_keyword("RETAIN")) {
      common.retain = true;
    } else if (skip_keyword("CONSTANT")) {
      common.constant = true;
    } else {
      skip_keyword("NON_RETAIN");
    }
    while (skip_line_ends(), !at_keyword("END_VAR")) {
      if (at(TokenKind::end)) fail(head.place, word + " has no END_VAR");
      take_declaration(common);
    }
    next();
    skip(TokenKind::semicolon);
    skip_line_ends();
  }

  void take_declaration(const Declaration& common) {
    std::vector<Declaration> declared;
    do {
      skip_line_ends();
      declared.push_back(common);
      declared.back().place = peek().place;
      declared.back().name = take_name("a variable");
    } while (skip_line_ends(), skip(TokenKind::comma));

    Declaration shared;
    if (at_keyword("AT")) {
      if (declared.size() > 1) fail_here("AT places one variable: declare each on its own");
      next();
      if (!at(TokenKind::direct_address) && !at(TokenKind::identifier))
        fail_here("AT is followed by an address such as %IX0.0 or %MW5");
      shared.address_place = peek().place;
      shared.address = next().text;
    }
    expect(TokenKind::colon, "a variable needs its type: `name : BOOL;`");
    skip_line_ends();
    if (!at(TokenKind::identifier)) fail_here("the type is missing: `name : BOOL;`");
    shared.type_place = peek().place;
    shared.type = upper(next().text);
    skip_line_ends();
    if (skip(TokenKind::assign)) {
      skip_line_ends();
      const bool boolean = at_keyword("TRUE") || at_keyword("FALSE");
      if (!boolean && !at(TokenKind::literal)) fail_here("an initial value is a literal: `name : INT := 5;`");
      shared.initial_place = peek().place;
      shared.initial = next().text;
      skip_line_ends();
    }
    expect(TokenKind::semicolon, "a declaration ends with ;");
    for (Declaration& one : declared) {
      one.address = shared.address;
      one.address_place = shared.address_place;
      one.type = shared.type;
      one.type_place = shared.type_place;
      one.initial = shared.initial;
      one.initial_place = shared.initial_place;
      tree_.declarations.push_back(std::move(one));
    }
  }

  void take_statement() {
    if (at(TokenKind::end)) fail_here("END_PROGRAM is missing");
    Statement statement;
    statement.place = peek().place;
    if (at(TokenKind::identifier) && tokens_[position_ + 1].kind == TokenKind::colon) {
      statement.label_place = peek().place;
      statement.label = take_name("a label");
      next();
      statement.place = peek().place;
    }
    if (!at(TokenKind::line_end)) take_instruction(statement);
    tree_.statements.push_back(std::move(statement));
    if (at(TokenKind::semicolon)) fail_here("an instruction ends with its line, not with ;");
    if (!skip(TokenKind::line_end))
      fail_here(
          "the instruction ends here: each stands on a line of its own, with at most the operands it takes");
  }

  void take_instruction(Statement& statement) {
    if (at(TokenKind::right_parenthesis)) {
      statement.operation = upper(next().text);
      return;
    }
    if (!at(TokenKind::identifier)) fail_here("an instruction begins with an operator such as LD or AND");
    statement.operation = upper(next().text);
    if (skip(TokenKind::left_parenthesis)) {
      if (find_operation(statement.operation) == nullptr) {
        take_call_arguments(statement);
        return;
      }
      statement.opens_parenthesis = true;
      if (!at(TokenKind::line_end)) statement.operands.push_back(take_operand());
      return;
    }
    if (at(TokenKind::line_end)) return;
    statement.operands.push_back(take_operand());
    if (statement.operation.starts_with("CAL") && skip(TokenKind::left_parenthesis)) {
      take_call_arguments(statement);
      return;
    }
    while (skip(TokenKind::comma)) statement.operands.push_back(take_operand());
  }

  /// After the opening parenthesis, to the closing one.
  void take_call_arguments(Statement& statement) {
    const SourcePlace opened = tokens_[position_ - 1].place;
    skip_line_ends();
    if (skip(TokenKind::right_parenthesis)) return;
    const std::size_t given_before = statement.operands.size();
    do {
      skip_line_ends();
      if (at(TokenKind::end)) fail(opened, "this call is not closed: ) is missing");
      take_argument(statement);
      skip_line_ends();
    } while (skip(TokenKind::comma));
    if (!statement.arguments.empty() && statement.operands.size() > given_before)
      fail(opened, "name all parameters of a call or none");
    expect(TokenKind::right_parenthesis, "a parameter is followed by , or )");
  }

  void take_argument(Statement& statement) {
    const TokenKind second = tokens_[position_ + 1].kind;
    if (second != TokenKind::assign && second != TokenKind::arrow) {
      statement.operands.push_back(take_operand());
      return;
    }
    NamedArgument argument;
    argument.place = peek().place;
    if (!at(TokenKind::identifier)) fail_here("the name of a parameter is missing");
    argument.name = upper(next().text);
    argument.is_output = next().kind == TokenKind::arrow;
    argument.operand = take_operand();
    statement.arguments.push_back(std::move(argument));
  }

  Operand take_operand() {
    Operand operand;
    operand.place = peek().place;
    if (at(TokenKind::literal) || at_keyword("TRUE") || at_keyword("FALSE")) {
      operand.kind = Operand::Kind::literal;
    } else if (at(TokenKind::direct_address)) {
      operand.kind = Operand::Kind::direct_address;
    } else if (!at(TokenKind::identifier)) {
      fail_here("an operand is a variable, a literal or an address such as %IX0.0");
    }
    operand.text = upper(next().text);
    if (operand.kind == Operand::Kind::name && is_reserved(operand.text))
      fail(operand.place, operand.text + " is a word of the language, not an operand");
    if (operand.kind == Operand::Kind::name && skip(TokenKind::dot)) {
      if (!at(TokenKind::identifier))
        fail_here("after the point stands an input or output of the block: t.Q");
      operand.member = upper(next().text);
    }
    return operand;
  }

  std::vector<Token> tokens_;
  std::size_t position_ = 0;
  SyntaxTree tree_;
};

}  // namespace

bool is_reserved(std::string_view upper_name) noexcept {
  return find_operation(upper_name) != nullptr || contains(other_operators, upper_name) ||
         contains(keywords, upper_name) || elementary_type(upper_name).has_value();
}

tl::expected<SyntaxTree, IlError> parse(std::string_view source) {
  auto tokens = tokenize(source);
  if (!tokens) return tl::unexpected(tokens.error());
  try {
    return Parser{std::move(*tokens)}.run();
  } catch (IlFailure& found) {
    return tl::unexpected(std::move(found.error));
  }
}

}  // namespace emulator_models::soft_plc
