#include "kernel_mocks/operator_script_file.hpp"

#include <limits>
#include <string>

#include <fmt/format.h>

#include "kernel_mocks/toml_rows.hpp"

namespace kernel_mocks {
namespace {

constexpr std::int64_t at_ms_max = std::int64_t{30} * 24 * 3600 * 1000;

std::optional<ConfigError> take_row(const toml::table& row, OperatorScript& script) {
  if (auto error = check_keys(row, {"at_ms", "block", "press"})) return error;
  const toml::node* const at = row.get("at_ms");
  const toml::node* const block = row.get("block");
  if ((at == nullptr) == (block == nullptr)) return error_at(row, "an event needs either 'at_ms' or 'block'");
  OperatorScriptEntry entry{};
  if (at != nullptr) {
    const auto time = at->value_exact<std::int64_t>();
    if (!time || *time < 0 || *time > at_ms_max) {
      return error_at(*at, fmt::format("'at_ms' is a number from 0 to {}", at_ms_max));
    }
    entry.when = std::chrono::nanoseconds{std::chrono::milliseconds{*time}};
  } else {
    const auto number = block->value_exact<std::int64_t>();
    if (!number || *number < 0 || *number > std::numeric_limits<std::uint32_t>::max()) {
      return error_at(*block, "'block' is the number of a block, as its N word has it");
    }
    entry.when = static_cast<std::uint32_t>(*number);
  }
  const toml::node* const press = row.get("press");
  if (press == nullptr) return error_at(row, "an event needs 'press', e.g. press = \"feed-hold\"");
  std::string known;
  for (unsigned index = 0; index < operator_event_count; ++index) {
    entry.event = static_cast<OperatorEvent>(index);
    if (press->value_exact<std::string>() == to_string(entry.event)) {
      script.push_back(entry);
      return std::nullopt;
    }
    known += (known.empty() ? "" : ", ") + std::string{to_string(entry.event)};
  }
  return error_at(*press, fmt::format("'press' is one of {}", known));
}

}  // namespace

tl::expected<OperatorScript, ConfigError> parse_operator_script(std::string_view text) {
  OperatorScript script;
  if (auto error =
          for_each_row(text, "event", [&](const toml::table& row) { return take_row(row, script); })) {
    return tl::unexpected{*error};
  }
  return script;
}

}  // namespace kernel_mocks
