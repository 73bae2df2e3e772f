#include "kernel_mocks/block_plan.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

using PlcWord = std::optional<std::uint16_t>;

tl::expected<PlcWord, NcError> plc_word(const Block& block, char letter) {
  const Word* const word = block.find(letter);
  if (word == nullptr) return PlcWord{};
  if (!word->value.is_whole() || word->value.is_negative() ||
      word->value.whole() > std::numeric_limits<std::uint16_t>::max()) {
    return tl::unexpected{NcError{NcFault::does_not_fit_plc_word, block.line, to_string(*word)}};
  }
  return static_cast<std::uint16_t>(word->value.whole());
}

bool is_motion_word(const Word& word) noexcept {
  if (word.letter == 'G') return word.value == Decimal::from_whole(4);
  return std::string_view{"XYZABCUVWIJK"}.find(word.letter) != std::string_view::npos;
}

FunctionRequest request_of(const MachineFunction& function) {
  return {.m = function.code,
          .s = {},
          .t = {},
          .acknowledgement = function.acknowledgement,
          .spindle = function.spindle};
}

}  // namespace

std::string to_string(const FunctionRequest& request) {
  std::string text;
  const auto append = [&text](char letter, PlcWord value) {
    if (value) text += fmt::format("{}{}{}", text.empty() ? "" : " ", letter, *value);
  };
  append('M', request.m);
  append('S', request.s);
  append('T', request.t);
  return text;
}

tl::expected<BlockPlan, NcError> plan_block(const Block& block, const MachineTable& table) {
  std::vector<const MachineFunction*> functions;
  for (const Word& word : block.words) {
    if (word.letter != 'M') continue;
    const MachineFunction* const function = table.find(static_cast<std::uint8_t>(word.value.whole()));
    if (function == nullptr) {
      return tl::unexpected{NcError{NcFault::m_code_not_in_machine_table, block.line, to_string(word)}};
    }
    // Behind those of the same rank: as written.
    functions.insert(std::ranges::upper_bound(functions, function->rank, {}, &MachineFunction::rank),
                     function);
  }

  BlockPlan plan;
  plan.has_motion = std::ranges::any_of(block.words, is_motion_word);
  for (const MachineFunction* const function : functions) {
    if (function->flow != ProgramFlow::none) plan.flow = function->flow;
    if (!function->sent_to_plc) continue;
    auto& place = function->effect == EffectPoint::begin ? plan.begin : plan.end;
    place.push_back(request_of(*function));
  }

  const auto s = plc_word(block, 'S');
  if (!s) return tl::unexpected{s.error()};
  const auto t = plc_word(block, 'T');
  if (!t) return tl::unexpected{t.error()};
  if (*s || *t) {
    if (plan.begin.empty()) plan.begin.emplace_back();
    FunctionRequest& first = plan.begin.front();
    first.s = *s;
    first.t = *t;
    // One FIN for all of them: the slowest decides.
    first.acknowledgement = Acknowledgement::before_going_on;
  }
  return plan;
}

tl::expected<void, NcError> check_for_machine(const Program& program, const MachineTable& table) {
  for (const Block& block : program.blocks) {
    if (const auto plan = plan_block(block, table); !plan) return tl::unexpected{plan.error()};
  }
  return {};
}

}  // namespace kernel_mocks
