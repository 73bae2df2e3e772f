#include "emulator_models/plants/propulsion_rules.hpp"

#include <cstdlib>

namespace emulator_models {

using namespace std::chrono_literals;
namespace wire = propulsion;

namespace {

/// What is controlled every 100 ms may come that much later, and one slow scan.
constexpr std::chrono::nanoseconds control_slack = 200ms;

constexpr std::array<std::string_view, propulsion_rules_count> names{
    "AHEAD_SWITCH",  "ANTI_WINDUP",       "ASTERN_SWITCH",     "BUZZER_ACK",    "DEAD_BAND",
    "LEVER_RANGE",   "LINK_ALARM",        "LINK_HOLD",         "LOCAL_CONTROL", "OIL_AFTER_RUN",
    "OIL_BUZZER",    "OIL_LAMP",          "OIL_SPEED_LIMIT",   "OIL_START",     "OIL_STOP",
    "ORDER_LIMIT",   "PUMP_1_PROTECTION", "PUMP_2_PROTECTION", "RAMP",          "REMOTE_RETURN",
    "SHAFT_BLOCKED", "STANDBY_PUMP",      "START_AT_ZERO",     "START_EDGE",    "STATION_STOP",
    "STOP_BUTTON",   "STOP_SWITCH",       "SWITCH_PROVED",     "TAKE_OVER",     "TORQUE_LIMIT",
    "TRIP_LATCH"};

}  // namespace

std::string_view name_of(PropulsionRule rule) noexcept { return names[static_cast<std::size_t>(rule)]; }

void PropulsionRules::Duration::update(bool condition, SteadyTime now) noexcept {
  if (!condition) {
    since_.reset();
    passed_.reset();
    return;
  }
  if (!since_) since_ = now;
  passed_ = now - *since_;
}

void PropulsionRules::observe(const Terminals& terminals, const PropulsionContract& contract,
                              SteadyTime now) noexcept {
  before_ = scan_;
  scan_ = {terminals, contract};
  judge_start_and_stop(now);
  judge_oil(now);
  judge_pumps(now);
  judge_control(now);
  judge_lever();
  judge_speed();
}

void PropulsionRules::run_begins() noexcept {
  PropulsionRules anew;
  anew.broken_ = broken_;
  anew.tripped_ = tripped_;
  *this = anew;
}

void PropulsionRules::judge_start_and_stop(SteadyTime now) noexcept {
  using enum PropulsionRule;
  const bool pumps_rest = !scan_.in(wire::pump_1_runs) && !scan_.in(wire::pump_2_runs);
  pressure_without_pump_.update(pumps_rest && scan_.in(wire::oil_pressure), now);
  if (pressure_without_pump_.reached(5s)) pressure_proved_ = false;
  if (pumps_rest && !scan_.in(wire::oil_pressure)) pressure_proved_ = true;

  const auto start_ordered = [](const Scan& scan) {
    return scan.in(wire::start_button) || scan.on(wire::pc_start);
  };
  if (scan_.out(wire::run) && !before_.out(wire::run)) {
    demand(oil_start, scan_.in(wire::oil_pressure));
    demand(start_at_zero, scan_.word(wire::target) == 0);
    demand(switch_proved, pressure_proved_);
    demand(trip_latch, !tripped_);
    demand(start_edge, start_ordered(scan_) && !start_ordered(before_));
  }
  demand(trip_latch, !tripped_ || scan_.on(wire::tripped) || scan_.acknowledged());
  tripped_ = scan_.on(wire::tripped);
  demand(stop_button, scan_.in(wire::stop_button) || !scan_.out(wire::run));
  demand(station_stop, !scan_.on(wire::pc_stop) || !scan_.out(wire::run));

  const bool standing =
      std::abs(static_cast<std::int16_t>(scan_.terminals.analog_inputs[wire::speed_input])) < 50;
  const bool driven =
      std::abs(static_cast<std::int16_t>(scan_.terminals.analog_outputs[wire::torque_output])) > 500;
  driven_and_standing_.update(scan_.out(wire::run) && driven && standing, now);
  demand(shaft_blocked, !driven_and_standing_.reached(5s + control_slack));
}

void PropulsionRules::judge_oil(SteadyTime now) noexcept {
  using enum PropulsionRule;
  const bool pressure = scan_.in(wire::oil_pressure);
  const bool low = scan_.out(wire::run) && !pressure;
  const bool was_low = before_.out(wire::run) && !before_.in(wire::oil_pressure);
  oil_low_.update(low, now);
  demand(oil_buzzer, !low || was_low || before_.on(wire::oil_alarm) || scan_.out(wire::buzzer));
  demand(oil_lamp, !low || scan_.out(wire::oil_lamp));
  demand(oil_lamp, pressure || !before_.out(wire::oil_lamp) || scan_.out(wire::oil_lamp));
  if (oil_low_.reached(5s + control_slack))
    demand(oil_speed_limit, std::abs(scan_.word(wire::setpoint)) <= 400);
  demand(oil_stop, !oil_low_.reached(10s));

  bool new_alarm = false;
  for (std::uint16_t number = wire::oil_alarm.number; number <= wire::speed_alarm.number; ++number) {
    const wire::Device bit{wire::DeviceKind::m, number};
    new_alarm |= scan_.on(bit) && !before_.on(bit);
  }
  const bool acknowledge = scan_.acknowledged() && !before_.acknowledged();
  demand(buzzer_ack, !acknowledge || new_alarm || !scan_.out(wire::buzzer));
}

void PropulsionRules::judge_pumps(SteadyTime now) noexcept {
  using enum PropulsionRule;
  const bool wanted = scan_.in(wire::pumps_switch) || scan_.on(wire::pc_pumps) || before_.out(wire::run);
  no_pressure_.update(wanted && !scan_.in(wire::oil_pressure), now);
  demand(standby_pump, !no_pressure_.reached(2500ms) || scan_.on(wire::standby_on));
  demand(pump_1_protection, scan_.in(wire::pump_1_protection) || !scan_.out(wire::pump_1));
  demand(pump_2_protection, scan_.in(wire::pump_2_protection) || !scan_.out(wire::pump_2));

  if (before_.out(wire::run)) last_run_ = now;
  const bool both_sound = scan_.in(wire::pump_1_protection) && scan_.in(wire::pump_2_protection);
  if (last_run_ && now - *last_run_ < 30s && both_sound)
    demand(oil_after_run, scan_.out(wire::pump_1) || scan_.out(wire::pump_2));
}

void PropulsionRules::judge_control(SteadyTime now) noexcept {
  using enum PropulsionRule;
  link_silent_.update(scan_.word(wire::pc_heartbeat) == before_.word(wire::pc_heartbeat), now);
  const bool lost = link_silent_.reached(2s);
  link_lost_in_remote_.update(lost && before_.on(wire::remote), now);
  demand(link_alarm, !link_lost_in_remote_.reached(5s) || scan_.on(wire::link_alarm));
  if (!lost) lever_at_loss_ = scan_.word(wire::lever);
  const bool remote = scan_.on(wire::remote);
  if (lost && remote && before_.on(wire::remote))
    demand(link_hold, scan_.word(wire::target) == before_.word(wire::target));
  demand(local_control, !scan_.in(wire::local_switch) || !remote);
  if (remote && !before_.on(wire::remote))
    demand(remote_return, scan_.on(wire::pc_remote) && !before_.on(wire::pc_remote));
  const bool lever_moved = std::abs(scan_.word(wire::lever) - lever_at_loss_) > 50;
  demand(take_over, !scan_.on(wire::link_alarm) || !lever_moved || !remote);
}

void PropulsionRules::judge_lever() noexcept {
  using enum PropulsionRule;
  const std::uint16_t word = scan_.terminals.analog_inputs[wire::lever_input];
  if (word < 360 || word > 2040) demand(lever_range, scan_.word(wire::lever) == before_.word(wire::lever));
  const std::int32_t target = scan_.word(wire::target);
  demand(order_limit, std::abs(target) <= wire::full_permille);
  if (scan_.on(wire::remote)) return;
  demand(dead_band, std::abs(scan_.word(wire::lever)) > 30 || target == 0);
  demand(ahead_switch, scan_.in(wire::lever_ahead) || target <= 0);
  demand(astern_switch, scan_.in(wire::lever_astern) || target >= 0);
  demand(stop_switch, !scan_.in(wire::lever_stop) || target == 0);
}

void PropulsionRules::judge_speed() noexcept {
  using enum PropulsionRule;
  const std::int32_t torque = static_cast<std::int16_t>(scan_.terminals.analog_outputs[wire::torque_output]);
  demand(torque_limit, std::abs(torque) <= wire::full_permille);
  const std::int32_t setpoint = scan_.word(wire::setpoint);
  const bool free = scan_.out(wire::run) && before_.out(wire::run) && !scan_.on(wire::speed_limited);
  if (free) demand(ramp, std::abs(setpoint - before_.word(wire::setpoint)) <= 10);
  // In saturation the integral takes in less than the error, so that it ends where the limit is.
  const std::int32_t unlimited = scan_.word(wire::unlimited);
  if (std::abs(unlimited) > wire::full_permille) {
    const std::int32_t direction = unlimited > 0 ? 1 : -1;
    const std::int32_t growth = direction * (scan_.word(wire::integral) - before_.word(wire::integral));
    const std::int32_t error = direction * (setpoint - scan_.word(wire::speed));
    demand(anti_windup, growth <= 0 || growth < error);
  }
}

}  // namespace emulator_models
