// An instruction-list program as it is written: declarations and instructions, nothing checked but the form.
//
// Names are kept twice: in capitals, as they are compared, and by their place, as messages show them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator_models/soft_plc/il_error.hpp"

namespace emulator_models::soft_plc {

enum class VariableSection : std::uint8_t { local, input, output };

/// One variable of a VAR block: `a AT %QX0.1 : BOOL := TRUE;`
struct Declaration {
  SourcePlace place;
  std::string name;
  VariableSection section = VariableSection::local;
  bool retain = false;
  bool constant = false;
  std::string_view address;  ///< empty without AT
  SourcePlace address_place;
  std::string type;
  SourcePlace type_place;
  std::string_view initial;  ///< a literal; empty without :=
  SourcePlace initial_place;
};

struct Operand {
  enum class Kind : std::uint8_t { name, literal, direct_address };

  Kind kind = Kind::name;
  SourcePlace place;
  std::string text;    ///< in capitals
  std::string member;  ///< of `t.Q`: Q; else empty
};

/// `IN := x` or `Q => y`.
struct NamedArgument {
  SourcePlace place;
  std::string name;
  bool is_output = false;
  Operand operand;
};

struct Statement {
  SourcePlace place;
  std::string label;  ///< empty: none
  SourcePlace label_place;
  /// In capitals; ")" for the end of a deferred operation; empty for a label on a line of its own.
  std::string operation;
  bool opens_parenthesis = false;  ///< `AND(`, `ADD( x`
  std::vector<Operand> operands;
  std::vector<NamedArgument> arguments;  ///< of a call in formal form
};

struct SyntaxTree {
  std::string program_name;
  std::vector<Declaration> declarations;
  std::vector<Statement> statements;
};

}  // namespace emulator_models::soft_plc
