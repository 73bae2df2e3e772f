// A TOML table read strictly: each key has one type and a range, and a key that nobody has asked for is a mistake.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace emulator_models::soft_plc {

/// How the reader gives up; parse_configuration() turns it into a value.
struct ConfigurationFailure {
  toml::source_position place;
  std::string message;
};

[[noreturn]] void refuse(const toml::source_region& region, std::string message);

class TomlTable {
 public:
  /// @param name  as in messages: "[[cycle]]"
  TomlTable(const toml::table& table, std::string name) : table_{table}, name_{std::move(name)} {}

  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] const toml::source_region& region(std::string_view key) const;

  // Each throws ConfigurationFailure: a value of another type or out of range; a missing key that is required.
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t fallback, std::int64_t least,
                                     std::int64_t most);
  [[nodiscard]] std::int64_t required_integer(std::string_view key, std::int64_t least, std::int64_t most);
  [[nodiscard]] bool boolean(std::string_view key, bool fallback);
  [[nodiscard]] std::string required_text(std::string_view key);
  /// @return the index of the word in `allowed`
  [[nodiscard]] std::size_t one_of(std::string_view key, const std::vector<std::string_view>& allowed);
  [[nodiscard]] std::vector<std::string> texts(std::string_view key);
  [[nodiscard]] std::vector<std::int64_t> integers(std::string_view key, std::int64_t least,
                                                   std::int64_t most);
  /// The sub-table; an empty one if it is missing.
  [[nodiscard]] TomlTable table(const std::string& key);
  /// The tables of [[key]]; none if it is missing.
  [[nodiscard]] std::vector<TomlTable> tables(const std::string& key);

  /// Once all keys were asked for.
  void refuse_the_rest() const;

 private:
  const toml::node* find(std::string_view key);
  const toml::node& require(std::string_view key);

  const toml::table& table_;
  std::string name_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace emulator_models::soft_plc
