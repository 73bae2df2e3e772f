// Labels of a program: where they are, what jumps to them, and the CR with which one arrives.
//
// A label's CR is kept from pass to pass and only ever gets less definite, so passes come to an end.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "emulator_models/soft_plc/il_current_result.hpp"
#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

class LabelTable {
 public:
  /// Throws IlFailure: a label that stands twice.
  explicit LabelTable(std::span<const Statement> statements);

  void begin_pass() noexcept;
  [[nodiscard]] bool changed_in_this_pass() const noexcept { return changed_; }
  /// From now on every label counts as one without a CR.
  void forget_current_results() noexcept;

  /// @param cr    on the way from the line above
  /// @param code_index  of the next instruction
  /// @return      the CR from here on
  CurrentResult arrive(const std::string& label, CurrentResult cr, std::size_t code_index);

  /// The jump at `code_index` goes to the label with this CR. Throws IlFailure: no such label.
  void jump(const std::string& label, SourcePlace place, CurrentResult cr, std::size_t code_index);

  /// Gives all jumps of this pass their targets.
  void resolve(std::vector<Instruction>& code) const;

 private:
  struct Label {
    CurrentResult cr;
    std::size_t code_index = 0;
  };
  struct Jump {
    const Label* target = nullptr;
    std::size_t code_index = 0;
  };

  void meet(Label& label, CurrentResult cr) noexcept;

  std::unordered_map<std::string, Label> labels_;
  std::vector<Jump> jumps_;
  bool changed_ = false;
};

}  // namespace emulator_models::soft_plc
