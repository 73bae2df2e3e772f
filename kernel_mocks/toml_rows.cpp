#include "kernel_mocks/toml_rows.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/toml_nesting.hpp"

namespace kernel_mocks {

std::string to_string(const ConfigError& error) {
  if (error.line == 0) return error.reason;
  return fmt::format("line {}, column {}: {}", error.line, error.column, error.reason);
}

ConfigError error_at(const toml::node& node, std::string reason) {
  return {node.source().begin.line, node.source().begin.column, std::move(reason)};
}

std::optional<ConfigError> check_keys(const toml::table& table,
                                      std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : table) {
    if (std::ranges::find(known, key.str()) == known.end()) {
      return error_at(value,
                      fmt::format("unknown key '{}'; known are {}", key.str(), fmt::join(known, ", ")));
    }
  }
  return std::nullopt;
}

std::optional<ConfigError> for_each_row(
    std::string_view text, std::string_view name,
    const std::function<std::optional<ConfigError>(const toml::table& row)>& take) {
  if (const auto place = protocol::too_deep_nesting(text)) {
    return ConfigError{place->line, place->column,
                       fmt::format("this nests deeper than {} levels; the file is tables of [[{}]]",
                                   protocol::toml_nesting_max, name)};
  }
  try {
    const toml::table root = toml::parse(text);
    if (auto error = check_keys(root, {name})) return error;
    const toml::node* const node = root.get(name);
    if (node == nullptr) return ConfigError{0, 0, fmt::format("no [[{}]] in the file", name)};
    const toml::array* const rows = node->as_array();
    if (rows == nullptr) return error_at(*node, fmt::format("'{0}' is an array of tables: [[{0}]]", name));
    for (const toml::node& row : *rows) {
      if (!row.is_table()) return error_at(row, fmt::format("'{0}' is an array of tables: [[{0}]]", name));
      if (auto error = take(*row.as_table())) return error;
    }
  } catch (const toml::parse_error& error) {
    return ConfigError{error.source().begin.line, error.source().begin.column,
                       std::string{error.description()}};
  }
  return std::nullopt;
}

}  // namespace kernel_mocks
