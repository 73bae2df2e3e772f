// Judges the PLC program of the propulsion station: shown what the scan saw and did, it names the rules that
// are broken. It shares nothing with the program but the wiring; every time is measured anew.
//
// A rule has the name of the line of propulsion.il that keeps it; propulsion.md says each in words. The plant
// is judged by its terminals alone: a program cannot answer for what no wire tells it.
// Invariants
//   I1  the same scans give the same verdicts; time comes with each scan.
//   I2  a rule once broken stays named until the observer is made anew.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "emulator_models/plants/propulsion_devices.hpp"
#include "emulator_models/plants/terminals.hpp"
#include "emulator_models/special_devices.hpp"

namespace emulator_models {

enum class PropulsionRule : std::uint8_t {
  ahead_switch,
  anti_windup,
  astern_switch,
  buzzer_ack,
  dead_band,
  lever_range,
  link_alarm,
  link_hold,
  local_control,
  oil_after_run,
  oil_buzzer,
  oil_lamp,
  oil_speed_limit,
  oil_start,
  oil_stop,
  order_limit,
  pump_1_protection,
  pump_2_protection,
  ramp,
  remote_return,
  shaft_blocked,
  standby_pump,
  start_at_zero,
  start_edge,
  station_stop,
  stop_button,
  stop_switch,
  switch_proved,
  take_over,
  torque_limit,
  trip_latch,
};
inline constexpr std::size_t propulsion_rules_count = 31;
using BrokenPropulsionRules = std::bitset<propulsion_rules_count>;

/// As the program writes it: "OIL_START".
[[nodiscard]] std::string_view name_of(PropulsionRule rule) noexcept;

/// The devices M100 to M139 and D100 to D139 after a scan.
struct PropulsionContract {
  static constexpr std::size_t first = 100;
  static constexpr std::size_t count = 40;

  std::bitset<count> bits;
  std::array<std::int16_t, count> words{};

  [[nodiscard]] bool on(propulsion::Device bit) const noexcept { return bits[bit.number - first]; }
  [[nodiscard]] std::int32_t word(propulsion::Device word) const noexcept {
    return words[word.number - first];
  }
};

class PropulsionRules {
 public:
  /// After each scan in RUN.
  /// @param terminals  the inputs that the scan latched and the outputs that it wrote
  /// @param now        of the scan; never earlier than in the call before
  void observe(const Terminals& terminals, const PropulsionContract& contract, SteadyTime now) noexcept;

  /// The PLC goes from STOP to RUN: what its program forgets by that, the observer forgets. A trip is not forgotten.
  void run_begins() noexcept;

  [[nodiscard]] const BrokenPropulsionRules& broken() const noexcept { return broken_; }

 private:
  /// How long something has been so, without a pause.
  class Duration {
   public:
    void update(bool condition, SteadyTime now) noexcept;
    [[nodiscard]] bool reached(std::chrono::nanoseconds time) const noexcept {
      return passed_ && *passed_ >= time;
    }

   private:
    std::optional<SteadyTime> since_;
    std::optional<std::chrono::nanoseconds> passed_;
  };

  struct Scan {
    Terminals terminals;
    PropulsionContract contract;

    [[nodiscard]] bool in(propulsion::Device x) const noexcept { return terminals.inputs[x.number]; }
    [[nodiscard]] bool out(propulsion::Device y) const noexcept { return terminals.outputs[y.number]; }
    [[nodiscard]] bool on(propulsion::Device m) const noexcept { return contract.on(m); }
    [[nodiscard]] std::int32_t word(propulsion::Device d) const noexcept { return contract.word(d); }
    [[nodiscard]] bool acknowledged() const noexcept {
      return in(propulsion::acknowledge_button) || on(propulsion::pc_acknowledge);
    }
  };

  void demand(PropulsionRule rule, bool kept) noexcept {
    if (!kept) broken_.set(static_cast<std::size_t>(rule));
  }
  void judge_start_and_stop(SteadyTime now) noexcept;
  void judge_oil(SteadyTime now) noexcept;
  void judge_pumps(SteadyTime now) noexcept;
  void judge_control(SteadyTime now) noexcept;
  void judge_lever() noexcept;
  void judge_speed() noexcept;

  BrokenPropulsionRules broken_;
  Scan before_;
  Scan scan_;
  Duration oil_low_;
  Duration no_pressure_;
  Duration pressure_without_pump_;
  Duration link_silent_;
  Duration link_lost_in_remote_;
  Duration driven_and_standing_;
  bool pressure_proved_ = false;
  bool tripped_ = false;
  std::int32_t lever_at_loss_ = 0;
  std::optional<SteadyTime> last_run_;
};

}  // namespace emulator_models
