#include "emulator_models/soft_plc/toml_table.hpp"

#include <utility>

#include <fmt/format.h>

namespace emulator_models::soft_plc {

void refuse(const toml::source_region& region, std::string message) {
  throw ConfigurationFailure{region.begin, std::move(message)};
}

namespace {

std::int64_t as_integer(const toml::node& node, std::string_view what, std::int64_t least,
                        std::int64_t most) {
  const auto* const value = node.as_integer();
  if (value == nullptr || value->get() < least || value->get() > most)
    refuse(node.source(), fmt::format("{} must be an integer from {} to {}", what, least, most));
  return value->get();
}

std::string as_text(const toml::node& node, std::string_view what) {
  const auto* const value = node.as_string();
  if (value == nullptr || value->get().empty())
    refuse(node.source(), fmt::format("{} must be a text in quotation marks, not empty", what));
  return value->get();
}

const toml::table empty_table{};

}  // namespace

const toml::node* TomlTable::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

const toml::node& TomlTable::require(std::string_view key) {
  const toml::node* const node = find(key);
  if (node == nullptr) refuse(table_.source(), fmt::format("{} has no {}; it has to be given", name_, key));
  return *node;
}

bool TomlTable::has(std::string_view key) { return find(key) != nullptr; }

const toml::source_region& TomlTable::region(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  return node != nullptr ? node->source() : table_.source();
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t fallback, std::int64_t least,
                                std::int64_t most) {
  const toml::node* const node = find(key);
  return node == nullptr ? fallback : as_integer(*node, key, least, most);
}

std::int64_t TomlTable::required_integer(std::string_view key, std::int64_t least, std::int64_t most) {
  return as_integer(require(key), key, least, most);
}

bool TomlTable::boolean(std::string_view key, bool fallback) {
  const toml::node* const node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) refuse(node->source(), fmt::format("{} must be true or false", key));
  return node->as_boolean()->get();
}

std::string TomlTable::required_text(std::string_view key) { return as_text(require(key), key); }

std::size_t TomlTable::one_of(std::string_view key, const std::vector<std::string_view>& allowed) {
  const toml::node* const node = find(key);
  if (node == nullptr) return 0;
  const auto* const value = node->as_string();
  for (std::size_t i = 0; value != nullptr && i < allowed.size(); ++i) {
    if (value->get() == allowed[i]) return i;
  }
  refuse(node->source(), fmt::format("{} must be one of \"{}\"", key, fmt::join(allowed, "\", \"")));
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
  std::vector<std::string> found;
  const toml::node* const node = find(key);
  if (node == nullptr) return found;
  if (!node->is_array()) refuse(node->source(), fmt::format("{} must be a list of texts", key));
  for (const toml::node& element : *node->as_array())
    found.push_back(as_text(element, fmt::format("each of {}", key)));
  return found;
}

std::vector<std::int64_t> TomlTable::integers(std::string_view key, std::int64_t least, std::int64_t most) {
  std::vector<std::int64_t> found;
  const toml::node* const node = find(key);
  if (node == nullptr) return found;
  if (!node->is_array()) refuse(node->source(), fmt::format("{} must be a list of integers", key));
  for (const toml::node& element : *node->as_array())
    found.push_back(as_integer(element, fmt::format("each of {}", key), least, most));
  return found;
}

TomlTable TomlTable::table(const std::string& key) {
  const toml::node* const node = find(key);
  if (node == nullptr) return {empty_table, key};
  if (!node->is_table()) refuse(node->source(), fmt::format("{} must be a table", key));
  return {*node->as_table(), key};
}

std::vector<TomlTable> TomlTable::tables(const std::string& key) {
  std::vector<TomlTable> found;
  const toml::node* const node = find(key);
  if (node == nullptr) return found;
  const std::string name = fmt::format("[[{}]]", key);
  if (!node->is_array_of_tables())
    refuse(node->source(), fmt::format("{} must be tables, each under {}", key, name));
  for (const toml::node& element : *node->as_array()) found.push_back({*element.as_table(), name});
  return found;
}

void TomlTable::refuse_the_rest() const {
  for (const auto& [key, node] : table_) {
    if (known_.contains(key.str())) continue;
    refuse(key.source(),
           fmt::format("{} has no key {}; known here: {}", name_, key.str(), fmt::join(known_, ", ")));
  }
}

}  // namespace emulator_models::soft_plc
