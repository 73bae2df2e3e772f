// Evaluates a generated program as a tree, in numbers of 128 bits that are cut to their type's width afterwards. Shares nothing
// with the compiler and the machine but the names of types and faults.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "emulator_models/soft_plc/il_operations.hpp"
#include "property_tests/emulator_models/soft_plc/generated_program.hpp"

namespace property_tests {

class NaiveEvaluator {
 public:
  explicit NaiveEvaluator(const GeneratedProgram& program);

  /// @param now_ns  the time that T1 sees
  /// @return        what ended the scan before its end
  std::optional<emulator_models::soft_plc::FaultKind> scan(std::int64_t now_ns);

  /// Of variables by their name, and of the instances' outputs as "T1.Q".
  std::map<std::string, Wide> values;

 private:
  Wide value_of(const Expression& expression);
  /// @return whether the program goes on behind it
  bool execute(const Statement& statement);
  bool execute(const std::vector<Statement>& statements);
  void call_timer(bool in, Wide preset);
  void call_counter(bool up, bool reset, Wide preset);

  const GeneratedProgram& program_;
  Wide now_ = 0;
  std::optional<Wide> timer_start_;
  bool counter_input_ = false;
  bool edge_input_ = false;
};

/// What is left of a number in a variable of that type.
[[nodiscard]] Wide cut_to(ElementaryType type, Wide number);

}  // namespace property_tests
