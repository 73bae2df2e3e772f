// The operator's script of the kernel: whatever the text, it is refused with a place and a reason, or it prints and reads as
// itself, and an operator presses each of its buttons once.

#include <string>
#include <variant>

#include <fmt/format.h>

#include "fuzz/kernel_file_place.hpp"
#include "kernel_mocks/operator_script_file.hpp"

namespace {

using namespace kernel_mocks;
using namespace std::chrono_literals;
using ltsim::expect;

constexpr auto at_max = 24h * 30;

std::string row_of(const OperatorScriptEntry& entry) {
  const auto* const time = std::get_if<std::chrono::nanoseconds>(&entry.when);
  const std::string when = time != nullptr ? fmt::format("at_ms = {}", *time / 1ms)
                                           : fmt::format("block = {}", std::get<std::uint32_t>(entry.when));
  return fmt::format("[[event]]\n{}\npress = \"{}\"\n", when, to_string(entry.event));
}

std::size_t take_all(OperatorPanel& panel) {
  std::size_t count = 0;
  while (panel.take()) ++count;
  return count;
}

void press_all(const OperatorScript& script) {
  ScriptedOperator person{script};
  OperatorPanel panel;
  std::size_t pressed = 0;
  person.look(at_max, panel);
  pressed += take_all(panel);
  expect(person.has_left(), "who has no time to wait for has left");
  for (const OperatorScriptEntry& entry : script) {
    const auto* const block = std::get_if<std::uint32_t>(&entry.when);
    if (block != nullptr) person.block_begun(*block, panel);
    pressed += take_all(panel);
  }
  person.look(at_max, panel);
  expect(pressed == script.size() && take_all(panel) == 0, "each button is pressed once");
}

}  // namespace

FUZZ_TARGET("operator-script", {}, "the text of an operator's script: parsed, used, printed, parsed again") {
  const std::string_view text = fuzz::text_of(input);
  const auto script = parse_operator_script(text);
  if (!script) {
    fuzz::check_refusal(text, script.error());
    return;
  }
  std::string printed;
  for (const OperatorScriptEntry& entry : *script) {
    if (const auto* const time = std::get_if<std::chrono::nanoseconds>(&entry.when))
      expect(*time >= 0ns && *time <= at_max, "a time is within a month");
    printed += row_of(entry);
  }
  if (printed.empty()) printed = "event = []\n";
  const auto again = parse_operator_script(printed);
  expect(again && *again == *script, "a script that is printed reads as itself");
  press_all(*script);
}
