// The meaning of each operator of instruction list: which types it takes and which instructions it becomes.
//
// Calls of functions and function blocks are in il_call_compiler.cpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "emulator_models/soft_plc/il_code_builder.hpp"
#include "emulator_models/soft_plc/il_functions.hpp"
#include "emulator_models/soft_plc/il_labels.hpp"
#include "emulator_models/soft_plc/il_syntax.hpp"

namespace emulator_models::soft_plc {

class InstructionCompiler {
 public:
  static constexpr int passes_max = 16;

  /// All must outlive the compiler. Throws IlFailure, as do all members.
  InstructionCompiler(IlProgram& program, const SymbolTable& symbols, const SyntaxTree& tree,
                      const AddressMap& map);

  void run();

 private:
  /// An operator whose parenthesis is open.
  struct Deferred {
    Operation operation = Operation::bit_and;
    bool negated = false;
    PendingResult outer;
    SourcePlace place;
  };

  void pass();
  void compile(const Statement& statement);
  [[nodiscard]] bool is_dead(const Statement& statement) const;
  void expect_operands(const Statement& statement, std::size_t count) const;

  void load(const Statement& statement, bool negated);
  void store(const Statement& statement, bool negated);
  void set_or_reset(const Statement& statement);
  void negate(const Statement& statement);
  void operate(const Statement& statement, Operation operation, bool negated);
  void open_parenthesis(const Statement& statement, Operation operation, bool negated);
  void close_parenthesis(const Statement& statement);
  void jump(const Statement& statement, const std::string& condition);
  void return_from(const Statement& statement, const std::string& condition);

  void call_block(const Statement& statement, const std::string& condition);
  void call_with_arguments(const Statement& statement, InstancePlace instance);
  void input_operator(const Statement& statement);
  void call_function(const Statement& statement, const IlFunction& function);
  [[nodiscard]] std::vector<Operand> formal_arguments(const Statement& statement,
                                                      const IlFunction& function) const;
  void apply_function(const IlFunction& function, std::span<const Operand> rest, const Statement& statement);
  void select(std::span<const Operand> choices, const Statement& statement);
  void shift(ShiftKind kind, const Operand& count, const Statement& statement);

  /// CR := CR OP operand, with the types checked.
  void operate_with(Operation operation, bool negated, const Operand& operand, const Statement& statement);
  void emit_operation(Operation operation, bool negated, const ValuePlace& right, SourcePlace place);
  void emit_bit_operation(Operation operation, bool negated, const ValuePlace& right, SourcePlace place);
  void emit_deferred_operation(const Deferred& deferred, ElementaryType type, std::size_t slot);
  void load_operand(const Operand& operand);
  void store_to(const ValuePlace& target, const std::string& name, bool negated, SourcePlace place);
  /// @return the index of a jump that is taken when the condition, "C" or "CN", does not hold
  /// JMP and RET: the target is filled in later. @return the index of the jump
  std::size_t emit_jump(const Statement& statement, const std::string& condition);
  std::size_t emit_skip(const std::string& condition, SourcePlace place);

  [[nodiscard]] const Symbol* find(const Operand& operand) const;
  [[nodiscard]] ValuePlace value_of(const Operand& operand);
  [[nodiscard]] InstancePlace instance_of(const Operand& operand) const;
  [[nodiscard]] bool is_instance(const Operand& operand) const;

  IlProgram& program_;
  const AddressMap& map_;
  const SymbolTable& symbols_;
  const SyntaxTree& tree_;
  CodeBuilder builder_;
  LabelTable labels_;
  std::vector<Deferred> deferred_;
  std::vector<std::size_t> returns_;
  bool last_pass_ = false;
};

}  // namespace emulator_models::soft_plc
