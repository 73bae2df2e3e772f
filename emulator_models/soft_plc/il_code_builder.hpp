// Emits instructions and keeps track of the CR: its type, and the literals in it that still wait for one.
//
// LD 5 has no type until something that has one meets it: then every literal of the CR is given that type, in
// the code already emitted.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emulator_models/soft_plc/il_current_result.hpp"
#include "emulator_models/soft_plc/il_literal.hpp"
#include "emulator_models/soft_plc/il_operations.hpp"
#include "emulator_models/soft_plc/il_program.hpp"
#include "emulator_models/soft_plc/il_symbols.hpp"

namespace emulator_models::soft_plc {

/// An instruction whose operand is a literal without a type, or whose type is that of such a CR.
struct UntypedUse {
  std::size_t code_index = 0;
  std::optional<std::string> literal;
  SourcePlace place;
};

/// The CR with what waits in it.
struct PendingResult {
  CurrentResult cr;
  std::vector<UntypedUse> untyped;
};

/// Refuses an operation that the type has not: ADD of WORD, AND of INT, MOD of REAL. Throws IlFailure.
void check_has_operation(Operation operation, ElementaryType type, SourcePlace place);

class CodeBuilder {
 public:
  explicit CodeBuilder(IlProgram& program) noexcept : program_{program} {}

  /// Forgets all code; the CR is undefined, as at the begin of a program.
  void begin_pass();

  [[nodiscard]] std::size_t next_index() const noexcept { return program_.code.size(); }
  /// Throws IlFailure when the program is too long.
  /// @return the index of the instruction
  std::size_t emit(const Instruction& instruction, SourcePlace place);
  /// An instruction on a value; `detail` is the bit number when the value is a BOOL.
  std::size_t emit(Opcode opcode, const ValuePlace& value, SourcePlace place, std::uint8_t detail = 0);
  void point_to_next(std::size_t jump_index);
  [[nodiscard]] ValuePlace constant(ElementaryType type, std::uint64_t bits);

  [[nodiscard]] const CurrentResult& cr() const noexcept { return current_.cr; }
  void set_cr(CurrentResult cr);
  void set_type(ElementaryType type) { set_cr(CurrentResult::of(type)); }
  void mark_call() noexcept { current_.cr.after_call = true; }
  /// Takes the CR with what waits in it away; it is undefined then.
  [[nodiscard]] PendingResult take();
  void put_back(PendingResult pending) { current_ = std::move(pending); }

  /// Throws IlFailure unless there is a CR. Warns when it comes from before a CAL.
  void require_cr(SourcePlace place);
  /// Throws IlFailure unless the CR is of this type, or of literals that fit it.
  /// @param what  "AND": who asks, for the message
  void require_type(ElementaryType type, SourcePlace place, const std::string& what);

  /// LD of a literal.
  void load_literal(const std::string& text, SourcePlace place);
  void load(const ValuePlace& value, SourcePlace place);
  /// The CR and `other`, of another branch or of outside the parenthesis, become of one type, that of the CR.
  void unify(PendingResult& other, SourcePlace place, const std::string& what);
  /// CR := CR OP literal where neither has a type yet.
  void operate_untyped(Operation operation, const std::string& literal, SourcePlace place);
  /// CR := slot OP CR where neither has a type yet.
  void join_untyped(PendingResult outer, std::size_t operation_index, SourcePlace place);

 private:
  void settle(std::vector<UntypedUse>& uses, ElementaryType type);

  IlProgram& program_;
  PendingResult current_;
};

}  // namespace emulator_models::soft_plc
