#include "emulator_models/soft_plc/il_labels.hpp"

#include "emulator_models/soft_plc/il_failure.hpp"

namespace emulator_models::soft_plc {

LabelTable::LabelTable(std::span<const Statement> statements) {
  for (const Statement& statement : statements) {
    if (statement.label.empty()) continue;
    if (!labels_.emplace(statement.label, Label{}).second)
      fail(statement.label_place, "label " + statement.label + " stands twice: rename one");
  }
}

void LabelTable::begin_pass() noexcept {
  jumps_.clear();
  changed_ = false;
}

void LabelTable::forget_current_results() noexcept {
  for (auto& [name, label] : labels_) label.cr = CurrentResult::undefined();
}

void LabelTable::meet(Label& label, CurrentResult cr) noexcept {
  const CurrentResult both = merged(label.cr, cr);
  if (both == label.cr) return;
  label.cr = both;
  changed_ = true;
}

CurrentResult LabelTable::arrive(const std::string& label, CurrentResult cr, std::size_t code_index) {
  Label& here = labels_.at(label);
  here.code_index = code_index;
  meet(here, cr);
  return here.cr;
}

void LabelTable::jump(const std::string& label, SourcePlace place, CurrentResult cr, std::size_t code_index) {
  const auto found = labels_.find(label);
  if (found == labels_.end())
    fail(place,
         "there is no label " + label + " in this program: write `" + label + ":` where the jump is to go");
  meet(found->second, cr);
  jumps_.push_back({&found->second, code_index});
}

void LabelTable::resolve(std::vector<Instruction>& code) const {
  for (const Jump& jump : jumps_)
    code[jump.code_index].offset = static_cast<std::uint32_t>(jump.target->code_index);
}

}  // namespace emulator_models::soft_plc
