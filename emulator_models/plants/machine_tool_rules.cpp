#include "emulator_models/plants/machine_tool_rules.hpp"

#include <cmath>

namespace emulator_models {

using machine_tool::X;
using machine_tool::Y;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

namespace {

/// The drive's own bands plus a little: what two scans can change.
constexpr double turning_rpm = machine_tool::Spindle::zero_speed_rpm * 1.1;
constexpr double speed_band = 0.15;
constexpr milliseconds coolant_off_time{100};
constexpr milliseconds flow_time_max{3200};
constexpr milliseconds wait_max{5500};
/// A run that was cut short proves nothing about its pressure.
constexpr seconds whole_run{10};

constexpr std::array moving_outputs{Y::spindle_clockwise, Y::spindle_counter_clockwise,
                                    Y::spindle_orient,    Y::flood_pump,
                                    Y::mist_valve,        Y::hydraulic_pump,
                                    Y::chuck_clamp,       Y::chuck_unclamp,
                                    Y::pocket_down,       Y::magazine_clockwise,
                                    Y::arm_grip,          Y::magazine_counter_clockwise,
                                    Y::arm_exchange,      Y::tool_unclamp,
                                    Y::lubrication_pump,  Y::contactor};

bool ends_coolant(std::uint16_t m_code) noexcept {
  return m_code <= 2 || m_code == 9 || m_code == 30 || m_code == 60;
}

}  // namespace

std::string_view name_of(MachineToolRule rule) noexcept {
  constexpr std::array<std::string_view, machine_tool_rules_count> names{"spindle-door",
                                                                         "spindle-chuck",
                                                                         "directions",
                                                                         "reversal-through-zero",
                                                                         "coolant-off-in-time",
                                                                         "coolant-supervision",
                                                                         "feed-at-speed",
                                                                         "door-feed-hold",
                                                                         "door-unlock",
                                                                         "change-at-standstill",
                                                                         "change-at-position",
                                                                         "arm-and-magazine",
                                                                         "chuck-at-standstill",
                                                                         "fin-after-feedback",
                                                                         "no-restart-after-estop",
                                                                         "estop-drops-outputs",
                                                                         "waits-bounded",
                                                                         "lubrication-supervision",
                                                                         "outputs-off-when-stopped"};
  return names[static_cast<std::size_t>(rule)];
}

struct MachineToolRules::View {
  const Terminals& terminals;
  const MachineToolPlant& plant;
  const MachineToolContract& contract;
  SteadyTime now;

  [[nodiscard]] bool on(Y y) const noexcept { return terminals.outputs.test(index_of(y)); }
  [[nodiscard]] bool on(X x) const noexcept { return terminals.inputs.test(index_of(x)); }
  [[nodiscard]] bool spindle_on() const noexcept {
    return on(Y::spindle_clockwise) || on(Y::spindle_counter_clockwise);
  }
  [[nodiscard]] bool turns() const noexcept { return std::abs(plant.spindle().speed_rpm()) > turning_rpm; }
  [[nodiscard]] bool any_on() const noexcept {
    for (const Y y : moving_outputs) {
      if (on(y)) return true;
    }
    return false;
  }
};

void MachineToolRules::bound(MachineToolRule rule, bool wrong, nanoseconds limit, SteadyTime now) noexcept {
  const auto index = static_cast<std::size_t>(rule);
  if (wrong && !wrong_.test(index)) wrong_since_[index] = now;
  wrong_.set(index, wrong);
  if (wrong && now - wrong_since_[index] > limit) broken_.set(index);
}

MachineToolRules::Broken MachineToolRules::look(const Terminals& terminals, const MachineToolPlant& plant,
                                                const MachineToolContract& contract,
                                                SteadyTime now) noexcept {
  broken_.reset();
  const View view{terminals, plant, contract, now};
  look_at_spindle(view);
  look_at_changer(view);
  look_at_emergency_stop(view);
  look_at_functions(view);
  look_at_coolant(view);
  was_reset_ = contract.reset || view.on(X::reset_button);
  return broken_;
}

void MachineToolRules::look_at_spindle(const View& view) noexcept {
  using enum MachineToolRule;
  const double speed = view.plant.spindle().speed_rpm();
  const bool clockwise = view.on(Y::spindle_clockwise);
  const bool counter_clockwise = view.on(Y::spindle_counter_clockwise);
  const double ordered = view.terminals.analog_outputs[machine_tool::speed_order_word];
  const bool at_speed = std::abs(std::abs(speed) - ordered) <= speed_band * ordered;

  bound(spindle_door, view.spindle_on() && !(view.on(X::door_closed) && view.on(X::door_locked)), reaction_,
        view.now);
  bound(spindle_chuck, view.spindle_on() && !(view.on(X::chuck_clamped) && view.on(X::hydraulic_pressure)),
        reaction_, view.now);
  bound(directions, clockwise && counter_clockwise, nanoseconds{-1}, view.now);
  bound(reversal_through_zero,
        (clockwise && speed < -turning_rpm) || (counter_clockwise && speed > turning_rpm), nanoseconds{-1},
        view.now);
  bound(feed_at_speed, view.contract.feed_enable && view.spindle_on() && !at_speed, reaction_, view.now);
  bound(door_feed_hold, view.contract.feed_enable && !view.on(X::door_closed), reaction_, view.now);
  bound(door_unlock, view.on(Y::door_unlock) && (view.turns() || !view.contract.distribution_end), reaction_,
        view.now);
  bound(chuck_at_standstill, view.on(Y::chuck_unclamp) && view.turns(), nanoseconds{-1}, view.now);
}

void MachineToolRules::look_at_coolant(const View& view) noexcept {
  using enum MachineToolRule;
  const bool coolant = view.on(Y::flood_pump) || view.on(Y::mist_valve);
  bound(coolant_off_in_time, coolant && coolant_is_to_be_off_, coolant_off_time, view.now);
  const bool flows = (!view.on(Y::flood_pump) || view.on(X::flood_flow)) &&
                     (!view.on(Y::mist_valve) || view.on(X::mist_flow));
  bound(coolant_supervision, coolant && !flows, flow_time_max, view.now);

  const bool pump = view.on(Y::lubrication_pump);
  if (pump && !pump_was_on_) {
    pump_since_ = view.now;
    pressure_seen_ = false;
  }
  pressure_seen_ = pressure_seen_ || view.on(X::lubrication_pressure);
  if (pump_was_on_ && !pump) {
    // A run that a stop cuts short says nothing about the pressure.
    warning_is_due_ = !pressure_seen_ && view.now - pump_since_ >= whole_run && view.contract.plc_runs &&
                      view.on(X::chain_closed);
  }
  if (view.contract.warning_number != 0 || view.contract.reset || view.on(X::reset_button)) {
    warning_is_due_ = false;
  }
  pump_was_on_ = pump;
  bound(lubrication_supervision, warning_is_due_, reaction_, view.now);
}

void MachineToolRules::look_at_changer(const View& view) noexcept {
  using enum MachineToolRule;
  const machine_tool::ToolChanger& changer = view.plant.changer();
  const bool changing = changer.arm_moves() && view.on(Y::arm_grip);
  bound(change_at_standstill, (changing || view.on(Y::tool_unclamp)) && view.turns(), reaction_, view.now);
  bound(change_at_position, changing && !view.contract.z_at_change, reaction_, view.now);
  bound(arm_and_magazine, changer.magazine_moves() && (changer.arm_moves() || !changer.arm_is_home()),
        reaction_, view.now);
}

void MachineToolRules::look_at_emergency_stop(const View& view) noexcept {
  using enum MachineToolRule;
  const bool closed = view.on(X::chain_closed);
  const bool reset = view.contract.reset || view.on(X::reset_button);
  if (!closed) may_be_on_ = false;
  if (closed && reset && !was_reset_) may_be_on_ = true;
  bound(estop_drops_outputs, !closed && view.any_on(), reaction_, view.now);
  bound(no_restart_after_estop, closed && !may_be_on_ && view.any_on(), reaction_, view.now);
  bound(outputs_off_when_stopped, !view.contract.plc_runs && view.terminals.outputs.any(), reaction_,
        view.now);
  if (!closed || reset) coolant_is_to_be_off_ = true;
}

void MachineToolRules::look_at_functions(const View& view) noexcept {
  using enum MachineToolRule;
  const MachineToolContract& contract = view.contract;
  const bool reset = contract.reset || view.on(X::reset_button) || !view.on(X::chain_closed);
  const bool strobe = contract.m_strobe;
  if (strobe && !was_strobed_) {
    m_code_ = contract.m_code;
    if (ends_coolant(m_code_)) coolant_is_to_be_off_ = true;
    if (m_code_ == 7 || m_code_ == 8 || m_code_ == 13 || m_code_ == 14) {
      coolant_is_to_be_off_ = reset || contract.alarm;
    }
  }
  was_strobed_ = strobe;
  const bool any = strobe || contract.s_strobe || contract.t_strobe;
  if (contract.fin && !was_fin_ && strobe && !has_feedback(view, m_code_)) {
    broken_.set(static_cast<std::size_t>(fin_after_feedback));
  }
  was_fin_ = contract.fin;

  if (!any) strobe_counts_ = true;
  if (reset || contract.alarm) strobe_counts_ = false;
  const bool still = view.terminals.inputs == inputs_ && view.terminals.analog_inputs[0] == speed_rpm_ &&
                     any && strobe_counts_ && !contract.fin && contract.plc_runs;
  inputs_ = view.terminals.inputs;
  speed_rpm_ = view.terminals.analog_inputs[0];
  if (!still) nothing_happens_since_ = view.now;
  if (view.now - nothing_happens_since_ > wait_max) broken_.set(static_cast<std::size_t>(waits_bounded));
}

bool MachineToolRules::has_feedback(const View& view, std::uint16_t m_code) noexcept {
  const bool no_flow = !view.on(X::flood_flow) && !view.on(X::mist_flow);
  switch (m_code) {
    case 0:
    case 1:
    case 2:
    case 30:
    case 60:
      return no_flow && view.on(X::spindle_zero_speed);
    case 3:
      return view.on(Y::spindle_clockwise) && view.on(X::spindle_at_speed);
    case 4:
      return view.on(Y::spindle_counter_clockwise) && view.on(X::spindle_at_speed);
    case 5:
      return view.on(X::spindle_zero_speed);
    case 6:
      return view.plant.changer().tool_in_spindle() == view.contract.selected_tool &&
             view.on(X::tool_clamped) && view.on(X::arm_home);
    case 7:
      return view.on(X::mist_flow);
    case 8:
      return view.on(X::flood_flow);
    case 9:
      return no_flow;
    case 10:
      return view.on(X::chuck_clamped);
    case 11:
      return view.on(X::chuck_unclamped);
    case 13:
    case 14:
      return view.on(X::flood_flow) && view.on(X::spindle_at_speed);
    case 19:
      return view.on(X::spindle_oriented);
    default:
      return true;
  }
}

}  // namespace emulator_models
