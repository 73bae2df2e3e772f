#include "kernel_mocks/machine_table_file.hpp"

#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "kernel_mocks/toml_rows.hpp"

namespace kernel_mocks {
namespace {

template <typename Value, std::size_t count>
using Names = std::array<std::pair<std::string_view, Value>, count>;

struct Synchronisation {
  bool sent;
  /// Nothing: either.
  std::optional<EffectPoint> effect;
  Acknowledgement acknowledgement;
};

constexpr Names<EffectPoint, 2> effects{{{"begin", EffectPoint::begin}, {"end", EffectPoint::end}}};
constexpr Names<Synchronisation, 6> synchronisations{{
    {"NO_SYNCH", {false, {}, Acknowledgement::before_going_on}},
    {"MOS", {true, {}, Acknowledgement::before_next_function}},
    {"MVS_SVS", {true, EffectPoint::begin, Acknowledgement::before_going_on}},
    {"MVS_SNS", {true, EffectPoint::begin, Acknowledgement::at_block_end}},
    {"MNS_SNS", {true, EffectPoint::end, Acknowledgement::before_going_on}},
    {"MVS_SLM", {true, EffectPoint::begin, Acknowledgement::before_feed}},
}};
constexpr Names<ProgramFlow, 4> flows{{{"none", ProgramFlow::none},
                                       {"stop", ProgramFlow::stop},
                                       {"optional-stop", ProgramFlow::optional_stop},
                                       {"end", ProgramFlow::end}}};
constexpr Names<SpindleEffect, 3> spindles{
    {{"none", SpindleEffect::none}, {"start", SpindleEffect::start}, {"stop", SpindleEffect::stop}}};

/// @param value  stays as it is when the row has no such key
template <typename Value, std::size_t count>
std::optional<ConfigError> take_name(const toml::table& row, std::string_view key,
                                     const Names<Value, count>& names, Value& value) {
  const toml::node* const node = row.get(key);
  if (node == nullptr) return std::nullopt;
  const auto text = node->value_exact<std::string>();
  std::string known;
  for (const auto& [name, meant] : names) {
    if (text == name) {
      value = meant;
      return std::nullopt;
    }
    known += (known.empty() ? "" : ", ") + std::string{name};
  }
  return error_at(*node, fmt::format("'{}' is one of {}", key, known));
}

std::optional<unsigned> code_of(std::string_view text) {
  if (text.empty() || text.size() > 3) return std::nullopt;
  unsigned code = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    code = code * 10 + static_cast<unsigned>(c - '0');
  }
  return code <= MachineTable::code_max ? std::optional{code} : std::nullopt;
}

/// `m = 3` or `m = "100-199"`
std::optional<std::pair<unsigned, unsigned>> codes_of(const toml::node& node) {
  std::string text;
  if (const auto number = node.value_exact<std::int64_t>()) text = fmt::format("{}", *number);
  if (const auto range = node.value_exact<std::string>()) text = *range;
  const std::size_t dash = text.find('-');
  const auto first = code_of(std::string_view{text}.substr(0, dash));
  const auto last = dash == std::string::npos ? first : code_of(std::string_view{text}.substr(dash + 1));
  if (!first || !last || *first > *last) return std::nullopt;
  return std::pair{*first, *last};
}

std::optional<ConfigError> take_row(const toml::table& row, MachineTable& table) {
  if (auto error = check_keys(row, {"m", "effect", "synchronisation", "flow", "order", "spindle"}))
    return error;
  const toml::node* const m = row.get("m");
  if (m == nullptr) return error_at(row, "a function needs its M number: m = 3, or m = \"100-199\"");
  const auto codes = codes_of(*m);
  if (!codes) return error_at(*m, "'m' is a number from 0 to 199, or a range like \"100-199\"");
  MachineFunction function;
  if (row.get("effect") == nullptr) return error_at(row, "a function needs its effect: begin or end");
  if (auto error = take_name(row, "effect", effects, function.effect)) return error;

  const toml::node* const kind = row.get("synchronisation");
  if (kind == nullptr) return error_at(row, "a function needs its synchronisation, e.g. MVS_SVS");
  Synchronisation synchronisation{};
  if (auto error = take_name(row, "synchronisation", synchronisations, synchronisation)) return error;
  if (synchronisation.effect && *synchronisation.effect != function.effect) {
    return error_at(*kind,
                    "this synchronisation contradicts the effect: MVS_ kinds act at the begin, MNS_ kinds "
                    "at the end");
  }
  function.sent_to_plc = synchronisation.sent;
  function.acknowledgement = synchronisation.acknowledgement;
  if (auto error = take_name(row, "flow", flows, function.flow)) return error;
  if (function.flow != ProgramFlow::none && function.effect != EffectPoint::end) {
    return error_at(*row.get("flow"), "a stop or an end of the program acts at the end of its block");
  }
  if (auto error = take_name(row, "spindle", spindles, function.spindle)) return error;
  if (const toml::node* const order = row.get("order")) {
    const auto rank = order->value_exact<std::int64_t>();
    if (!rank || *rank < 0 || *rank > 255) return error_at(*order, "'order' is a number from 0 to 255");
    function.rank = static_cast<std::uint8_t>(*rank);
  }
  for (unsigned code = codes->first; code <= codes->second; ++code) {
    function.code = static_cast<std::uint8_t>(code);
    if (code == 98) return error_at(*m, "M98 calls a subprogram; there are none");
    if (table.find(function.code) != nullptr) return error_at(*m, fmt::format("M{} is there already", code));
    table.put(function);
  }
  return std::nullopt;
}

}  // namespace

tl::expected<MachineTable, ConfigError> parse_machine_table(std::string_view text) {
  MachineTable table;
  if (auto error =
          for_each_row(text, "function", [&](const toml::table& row) { return take_row(row, table); })) {
    return tl::unexpected{*error};
  }
  // The parser ends the program there, whatever the table says.
  for (const std::uint8_t code : {std::uint8_t{2}, std::uint8_t{30}, std::uint8_t{99}}) {
    const MachineFunction* const function = table.find(code);
    if (function != nullptr && function->flow != ProgramFlow::end) {
      return tl::unexpected{ConfigError{0, 0, fmt::format("M{} ends the program: flow = \"end\"", code)}};
    }
  }
  return table;
}

}  // namespace kernel_mocks
