#include "sim_clock/explore/duration_text.hpp"

#include <array>
#include <charconv>
#include <limits>

#include <fmt/format.h>

namespace ltsim {
namespace {

struct Unit {
  std::string_view name;
  std::int64_t ns;
};
constexpr std::array<Unit, 4> units{{{"s", 1'000'000'000}, {"ms", 1'000'000}, {"us", 1'000}, {"ns", 1}}};

}  // namespace

std::string to_text(SimTime duration) {
  for (const Unit& unit : units) {
    if (duration.count() % unit.ns == 0) return fmt::format("{}{}", duration.count() / unit.ns, unit.name);
  }
  return {};
}

std::optional<SimTime> parse_duration(std::string_view text) noexcept {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || number < 0) return std::nullopt;
  const std::string_view name = text.substr(static_cast<std::size_t>(end - text.data()));
  for (const Unit& unit : units) {
    if (name != unit.name) continue;
    if (number > std::numeric_limits<std::int64_t>::max() / unit.ns) return std::nullopt;
    return SimTime{number * unit.ns};
  }
  return std::nullopt;
}

}  // namespace ltsim
