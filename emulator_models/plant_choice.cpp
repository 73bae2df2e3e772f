#include "emulator_models/plant_choice.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "emulator_models/plants/machine_tool_plant.hpp"
#include "emulator_models/plants/propulsion_plant.hpp"
#include "emulator_models/programs/machine_tool_program.hpp"
#include "emulator_models/programs/propulsion_program.hpp"

namespace emulator_models {
namespace {

constexpr std::string_view plant_names[] = {"machine-tool", "propulsion", "none"};

// In the order of MachineToolFailure.
constexpr std::string_view machine_tool_failures[] = {
    "spindle-drive-fault",
    "flood-without-flow",
    "mist-without-flow",
    "coolant-level-low",
    "coolant-motor-overload",
    "hydraulic-pressure-missing",
    "hydraulic-motor-overload",
    "chuck-stuck",
    "lubrication-pressure-missing",
    "lubrication-level-low",
    "door-lock-broken",
    "over-travel",
    "drives-not-ready",
    "magazine-motor-overload",
    "magazine-stuck",
    "pocket-pulse-lost",
    "pocket-stuck",
    "arm-stuck",
    "tool-clamp-stuck",
};
static_assert(std::size(machine_tool_failures) == machine_tool_failures_count);

// In the order of PropulsionFailure.
constexpr std::string_view propulsion_failures[] = {
    "pump-1-without-pressure",
    "pump-2-without-pressure",
    "pump-1-overload",
    "pump-2-overload",
    "pressure-switch-stuck-closed",
    "pressure-switch-stuck-open",
    "lever-wire-broken",
    "lever-short-circuit",
    "lever-noise",
    "lever-servo-jammed",
    "astern-switch-stuck-open",
    "stop-switch-stuck-closed",
    "ahead-switch-stuck-open",
    "shaft-blocked",
    "speed-sensor-broken",
};
static_assert(std::size(propulsion_failures) == propulsion_failures_count);

std::span<const std::string_view> failures_of(PlantKind kind) noexcept {
  switch (kind) {
    case PlantKind::machine_tool:
      return machine_tool_failures;
    case PlantKind::propulsion:
      return propulsion_failures;
    case PlantKind::none:
      break;
  }
  return {};
}

struct TimedFailure {
  std::size_t number = 0;  ///< in the plant's enumeration
  std::chrono::nanoseconds after{0};
};

/// @return nothing when the text is no decimal number in range
std::optional<std::chrono::nanoseconds> parse_seconds(std::string_view text) noexcept {
  constexpr double longest_s = 1'000'000;
  double number = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  // Written so that what is not a number is refused, too.
  const bool in_range = number >= 0 && number <= longest_s;
  if (error != std::errc{} || end != text.data() + text.size() || !in_range) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>{number});
}

tl::expected<TimedFailure, std::string> parse_failure(PlantKind kind, std::string_view text) {
  const auto names = failures_of(kind);
  if (names.empty())
    return tl::unexpected(
        fmt::format("--failure {}: there is no machine that could fail (--plant none)", text));
  const std::string_view name = text.substr(0, text.find('@'));
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    return tl::unexpected(fmt::format("--failure {}: {} does not know this one; it has {}", text,
                                      to_string(kind), fmt::join(names, ", ")));
  TimedFailure failure{.number = static_cast<std::size_t>(found - names.begin())};
  if (name.size() == text.size()) return failure;
  const auto after = parse_seconds(text.substr(name.size() + 1));
  if (!after)
    return tl::unexpected(fmt::format(
        "--failure {}: after the @ stands a number of seconds from 0 to 1000000, as {}@2.5", text, name));
  failure.after = *after;
  return failure;
}

/// A plant and what is to happen to it.
template <class PlantType, class Failure>
class FailingPlant {
 public:
  explicit FailingPlant(std::vector<TimedFailure> failures) : to_come_{std::move(failures)} {}

  void advance(Terminals& terminals, SteadyTime now) noexcept {
    if (!start_) start_ = now;
    std::erase_if(to_come_, [&](const TimedFailure& failure) {
      if (now - *start_ < failure.after) return false;
      plant_.set_failure(static_cast<Failure>(failure.number), true);
      return true;
    });
    plant_.advance(terminals, now);
  }

 private:
  PlantType plant_;
  std::vector<TimedFailure> to_come_;
  std::optional<SteadyTime> start_;
};

template <class PlantType, class Failure>
FxPlc::Plant failing(std::vector<TimedFailure> failures) {
  // Shared, because a std::function must be copyable.
  return [plant = std::make_shared<FailingPlant<PlantType, Failure>>(std::move(failures))](
             Terminals& terminals, SteadyTime now) { plant->advance(terminals, now); };
}

}  // namespace

std::string_view to_string(PlantKind kind) noexcept { return plant_names[static_cast<std::size_t>(kind)]; }

std::optional<PlantKind> parse_plant(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(plant_names, name);
  if (found == std::end(plant_names)) return std::nullopt;
  return static_cast<PlantKind>(found - std::begin(plant_names));
}

std::string_view program_for(PlantKind kind) noexcept {
  switch (kind) {
    case PlantKind::machine_tool:
      return machine_tool_program();
    case PlantKind::propulsion:
      return propulsion_program();
    case PlantKind::none:
      break;
  }
  return "PROGRAM idle\nEND_PROGRAM\n";
}

tl::expected<FxPlc::Plant, std::string> make_plant(PlantKind kind, const std::vector<std::string>& failures) {
  std::vector<TimedFailure> timed;
  for (const std::string& text : failures) {
    const auto failure = parse_failure(kind, text);
    if (!failure) return tl::unexpected(failure.error());
    timed.push_back(*failure);
  }
  switch (kind) {
    case PlantKind::machine_tool:
      return failing<MachineToolPlant, MachineToolFailure>(std::move(timed));
    case PlantKind::propulsion:
      return failing<PropulsionPlant, PropulsionFailure>(std::move(timed));
    case PlantKind::none:
      break;
  }
  return FxPlc::Plant{};
}

}  // namespace emulator_models
