// The text of a part program: whatever it is, the parser ends with a program or with a refusal that names a line of the text
// and a word of that line; and what it lets through can be planned, block by block.

#include <algorithm>
#include <cmath>
#include <string>

#include "fuzz/text_input.hpp"
#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/motion.hpp"
#include "kernel_mocks/nc_parser.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace kernel_mocks;
using ltsim::expect;

bool is_same(const Program& one, const Program& other) {
  return one.number == other.number && one.blocks == other.blocks;
}

std::string without_blanks(std::string_view line) {
  std::string rest{line};
  std::erase_if(rest, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
  return rest;
}

void check_refusal(std::string_view text, const NcError& error) {
  const auto line = fuzz::line_of(text, error.line);
  expect(line.has_value(), "a refusal names a line of the text");
  // A byte that cannot be shown is named by its number.
  const bool shown = !error.word.starts_with('\\') || error.word.size() == 1;
  expect(!shown || without_blanks(*line).find(error.word) != std::string::npos,
         "a refusal names a word of its line");
  expect(!to_string(error).empty(), "a refusal has a reason");
}

/// The program as text again, each block on the line that it came from.
std::string text_of_program(const Program& program) {
  std::string text = "%";
  if (program.number) text += std::to_string(*program.number);
  std::uint32_t line = 1;
  for (const Block& block : program.blocks) {
    for (; line < block.line; ++line) text += '\n';
    if (block.optional_skip) text += '/';
    if (block.number) text += (block.alignment ? ':' : 'N') + std::to_string(*block.number);
    for (const Word& word : block.words) text += ' ' + to_string(word);
  }
  return text + "\n%\n";
}

bool has_long_line(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > line_bytes_max) return true;
    begin = end + 1;
  }
  return false;
}

void check_print(const Program& program) {
  // A block on the first line leaves no room for the %.
  if (!program.blocks.empty() && program.blocks.front().line == 1) return;
  const std::string text = text_of_program(program);
  // X.5 is printed as X0.5: a line may grow beyond what the parser takes.
  if (has_long_line(text)) return;
  const auto again = parse_program(text);
  expect(again && is_same(*again, program), "a program that is printed reads as itself");
}

/// Axis words and those of an arc, but for the codes that take them: G28, G30, G92.
bool moves(const Block& block) {
  const auto is_taken = [](const Word& word) {
    return word.letter == 'G' &&
           (word.value == Decimal::from_whole(28) || word.value == Decimal::from_whole(30) ||
            word.value == Decimal::from_whole(92));
  };
  const auto is_place = [](const Word& word) {
    return std::string_view{"XYZABCUVWIJKR"}.find(word.letter) != std::string_view::npos;
  };
  return std::ranges::any_of(block.words, is_place) && std::ranges::none_of(block.words, is_taken);
}

void check_motion_plan(const Program& program, const AxisOptions& axes) {
  MotionPlanner planner{axes};
  bool refused = false;
  for (const Block& block : program.blocks) {
    const auto planned = planner.plan(block);
    if (!planned) {
      expect(planned.error().line == block.line, "a motion that is refused is that of its block");
      refused = true;
      break;
    }
    expect(!moves(block) || (*planned && (*planned)->kind != MotionKind::dwell),
           "a block with axis words moves the axes");
    if (!*planned) continue;
    const Motion& motion = **planned;
    expect(motion.duration.count() >= 0 && motion.duration <= motion_duration_max,
           "a motion has a length of time");
    expect(std::isfinite(motion.z), "the axes are somewhere");
    const auto& travel = axes.travel[z_axis];
    constexpr double rounding = 1e-6;
    expect(!travel || (motion.z >= travel->min - rounding && motion.z <= travel->max + rounding),
           "no axis leaves its travel");
  }
  expect(refused == !check_motion(program, axes), "a motion is refused before anything moves, or never");
}

void check_functions(const Program& program) {
  bool refused = false;
  for (const Block& block : program.blocks) {
    const auto plan = plan_block(block);
    if (!plan) {
      expect(plan.error().line == block.line, "a function that is refused is one of its block");
      refused = true;
      break;
    }
    const auto m_count = std::ranges::count(block.words, 'M', &Word::letter);
    expect(static_cast<std::ptrdiff_t>(plan->begin.size() + plan->end.size()) <= m_count + 1,
           "a block has a handshake for each M function, and one for S and T at most");
  }
  expect(refused == !check_for_machine(program), "a function is refused before anything moves, or never");
}

AxisOptions small_machine() {
  AxisOptions axes;
  axes.travel.fill(AxisOptions::Travel{-500, 500});
  axes.time_percent = 50;
  return axes;
}

void check_program(std::string_view text, const Program& program) {
  std::uint32_t line = 0;
  for (const Block& block : program.blocks) {
    expect(block.line > line, "each block has a line of its own, in the order of the text");
    line = block.line;
  }
  expect(fuzz::line_of(text, std::max(line, 1U)).has_value(), "a block comes from a line of the text");
  check_print(program);
  check_functions(program);
  check_motion_plan(program, {});
  static const AxisOptions small = small_machine();
  check_motion_plan(program, small);
}

void read(std::string_view text, ParserOptions options) {
  const auto program = parse_program(text, options);
  const auto swapped = parse_program(fuzz::with_cases_swapped(text), options);
  expect(program.has_value() == swapped.has_value(), "lower case counts as upper case");
  if (program) {
    expect(is_same(*program, *swapped), "lower case counts as upper case");
    check_program(text, *program);
  } else {
    expect(program.error().fault == swapped.error().fault && program.error().line == swapped.error().line,
           "lower case counts as upper case");
    check_refusal(text, program.error());
  }
}

}  // namespace

FUZZ_TARGET("nc-program", {}, "the text of a part program: parsed, printed and parsed, planned") {
  const std::string_view text = fuzz::text_of(input);
  read(text, {.skip_optional_blocks = false});
  read(text, {.skip_optional_blocks = true});
}
