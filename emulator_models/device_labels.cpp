#include "emulator_models/device_labels.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "emulator_models/plants/machine_tool_wiring.hpp"
#include "emulator_models/plants/propulsion_devices.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

constexpr Device m(std::uint16_t number) noexcept { return {DeviceKind::m, number}; }
constexpr Device d(std::uint16_t number) noexcept { return {DeviceKind::d, number}; }
constexpr Device wire(machine_tool::X input) noexcept {
  return {DeviceKind::x, static_cast<std::uint16_t>(index_of(input))};
}
constexpr Device wire(machine_tool::Y output) noexcept {
  return {DeviceKind::y, static_cast<std::uint16_t>(index_of(output))};
}

constexpr std::array plc_labels{
    DeviceLabel{m(8061), "CPU-E"},      DeviceLabel{d(8061), "hardware error"},
    DeviceLabel{m(8062), "port error"}, DeviceLabel{d(8062), "port error code"},
    DeviceLabel{m(8067), "PROG-E"},     DeviceLabel{d(8067), "program error"},
    DeviceLabel{d(8069), "its line"},
};

using machine_tool::X;
using machine_tool::Y;
constexpr std::array machine_tool_labels{
    DeviceLabel{m(100), "MF"},
    DeviceLabel{d(100), "M code"},
    DeviceLabel{m(101), "SF"},
    DeviceLabel{d(101), "S value"},
    DeviceLabel{m(102), "TF"},
    DeviceLabel{d(102), "T number"},
    DeviceLabel{m(103), "DEN"},
    DeviceLabel{m(104), "program running"},
    DeviceLabel{m(105), "reset"},
    DeviceLabel{m(106), "feed hold"},
    DeviceLabel{m(107), "Z at tool change"},
    DeviceLabel{m(120), "FIN"},
    DeviceLabel{m(121), "alarm"},
    DeviceLabel{d(120), "alarm number"},
    DeviceLabel{d(121), "warning number"},
    DeviceLabel{m(122), "E-stop OK"},
    DeviceLabel{m(123), "spindle at speed"},
    DeviceLabel{m(124), "door closed"},
    DeviceLabel{m(125), "feed enable"},
    DeviceLabel{m(126), "cycle start enable"},
    DeviceLabel{d(110), "selected tool"},
    DeviceLabel{d(111), "tool in spindle"},
    DeviceLabel{d(112), "pocket at change"},
    DeviceLabel{d(114), "M under way"},
    DeviceLabel{d(115), "tool change step"},
    DeviceLabel{d(210), "speed ordered"},
    DeviceLabel{d(200), "speed"},
    DeviceLabel{wire(Y::spindle_clockwise), "spindle cw"},
    DeviceLabel{wire(Y::spindle_counter_clockwise), "spindle ccw"},
    DeviceLabel{wire(Y::spindle_orient), "spindle orient"},
    DeviceLabel{wire(Y::flood_pump), "flood pump"},
    DeviceLabel{wire(Y::mist_valve), "mist valve"},
    DeviceLabel{wire(Y::hydraulic_pump), "hydraulic pump"},
    DeviceLabel{wire(Y::chuck_clamp), "chuck clamp"},
    DeviceLabel{wire(Y::chuck_unclamp), "chuck unclamp"},
    DeviceLabel{wire(Y::magazine_clockwise), "magazine cw"},
    DeviceLabel{wire(Y::magazine_counter_clockwise), "magazine ccw"},
    DeviceLabel{wire(Y::pocket_down), "pocket down"},
    DeviceLabel{wire(Y::arm_grip), "arm grip"},
    DeviceLabel{wire(Y::arm_exchange), "arm exchange"},
    DeviceLabel{wire(Y::tool_unclamp), "tool unclamp"},
    DeviceLabel{wire(Y::lubrication_pump), "lubrication pump"},
    DeviceLabel{wire(Y::door_unlock), "door unlock"},
    DeviceLabel{wire(Y::contactor), "contactor"},
    DeviceLabel{wire(Y::red_lamp), "red lamp"},
    DeviceLabel{wire(Y::yellow_lamp), "yellow lamp"},
    DeviceLabel{wire(Y::green_lamp), "green lamp"},
    DeviceLabel{wire(Y::horn), "horn"},
    DeviceLabel{wire(X::spindle_at_speed), "at speed"},
    DeviceLabel{wire(X::spindle_zero_speed), "zero speed"},
    DeviceLabel{wire(X::spindle_drive_fault), "drive fault"},
    DeviceLabel{wire(X::spindle_oriented), "oriented"},
    DeviceLabel{wire(X::flood_flow), "flood flow"},
    DeviceLabel{wire(X::mist_flow), "mist flow"},
    DeviceLabel{wire(X::coolant_level_low), "coolant low"},
    DeviceLabel{wire(X::coolant_motor_overload), "coolant motor"},
    DeviceLabel{wire(X::hydraulic_pressure), "hydraulic pressure"},
    DeviceLabel{wire(X::hydraulic_motor_overload), "hydraulic motor"},
    DeviceLabel{wire(X::chuck_clamped), "chuck clamped"},
    DeviceLabel{wire(X::chuck_unclamped), "chuck unclamped"},
    DeviceLabel{wire(X::door_closed), "door closed"},
    DeviceLabel{wire(X::door_locked), "door locked"},
    DeviceLabel{wire(X::lubrication_pressure), "oil pressure"},
    DeviceLabel{wire(X::lubrication_level_low), "oil low"},
    DeviceLabel{wire(X::pocket_pulse), "pocket pulse"},
    DeviceLabel{wire(X::magazine_home), "magazine home"},
    DeviceLabel{wire(X::pocket_is_down), "pocket is down"},
    DeviceLabel{wire(X::pocket_is_up), "pocket is up"},
    DeviceLabel{wire(X::arm_home), "arm home"},
    DeviceLabel{wire(X::arm_gripping), "arm grips"},
    DeviceLabel{wire(X::arm_exchanged), "arm has exchanged"},
    DeviceLabel{wire(X::tool_clamped), "tool clamped"},
    DeviceLabel{wire(X::tool_unclamped), "tool unclamped"},
    DeviceLabel{wire(X::tool_present), "tool present"},
    DeviceLabel{wire(X::magazine_motor_overload), "magazine motor"},
    DeviceLabel{wire(X::chain_closed), "E-stop chain"},
    DeviceLabel{wire(X::buttons_released), "buttons released"},
    DeviceLabel{wire(X::over_travel_free), "no over-travel"},
    DeviceLabel{wire(X::drives_ready), "drives ready"},
    DeviceLabel{wire(X::contactor_on), "contactor on"},
    DeviceLabel{wire(X::door_button), "door button"},
    DeviceLabel{wire(X::reset_button), "reset button"},
};

namespace ship = propulsion;
constexpr std::array propulsion_labels{
    DeviceLabel{ship::pc_heartbeat, "PC heartbeat"},
    DeviceLabel{ship::pc_order, "PC order"},
    DeviceLabel{ship::pc_start, "PC start"},
    DeviceLabel{ship::pc_stop, "PC stop"},
    DeviceLabel{ship::pc_acknowledge, "PC acknowledge"},
    DeviceLabel{ship::pc_remote, "PC wants control"},
    DeviceLabel{ship::duty_is_pump_2, "duty is pump 2"},
    DeviceLabel{ship::pc_pumps, "PC pumps"},
    DeviceLabel{ship::ready, "ready"},
    DeviceLabel{ship::running, "running"},
    DeviceLabel{ship::alarm, "alarm"},
    DeviceLabel{ship::alarm_number, "alarm number"},
    DeviceLabel{ship::remote, "PC has control"},
    DeviceLabel{ship::link_lost, "link lost"},
    DeviceLabel{ship::speed_limited, "speed limited"},
    DeviceLabel{ship::standby_on, "standby pump"},
    DeviceLabel{ship::tripped, "tripped"},
    DeviceLabel{ship::oil_alarm, "alarm oil"},
    DeviceLabel{ship::pump_1_alarm, "alarm pump 1"},
    DeviceLabel{ship::pump_2_alarm, "alarm pump 2"},
    DeviceLabel{ship::lever_alarm, "alarm lever"},
    DeviceLabel{ship::link_alarm, "alarm link"},
    DeviceLabel{ship::blocked_alarm, "alarm blocked"},
    DeviceLabel{ship::switch_alarm, "alarm switch"},
    DeviceLabel{ship::mismatch_alarm, "alarm mismatch"},
    DeviceLabel{ship::speed_alarm, "alarm speed"},
    DeviceLabel{ship::lever, "lever"},
    DeviceLabel{ship::target, "order in force"},
    DeviceLabel{ship::setpoint, "speed set-point"},
    DeviceLabel{ship::speed, "speed"},
    DeviceLabel{ship::torque, "torque"},
    DeviceLabel{ship::heartbeat, "PLC heartbeat"},
    DeviceLabel{ship::pump_1, "pump 1"},
    DeviceLabel{ship::pump_2, "pump 2"},
    DeviceLabel{ship::run, "propulsion"},
    DeviceLabel{ship::lever_servo, "lever servo"},
    DeviceLabel{ship::buzzer, "buzzer"},
    DeviceLabel{ship::oil_lamp, "oil lamp"},
    DeviceLabel{ship::link_lamp, "link lamp"},
    DeviceLabel{ship::lever_lamp, "lever lamp"},
    DeviceLabel{ship::pump_lamp, "pump lamp"},
    DeviceLabel{ship::run_lamp, "run lamp"},
    DeviceLabel{ship::local_lamp, "local lamp"},
    DeviceLabel{ship::limit_lamp, "limit lamp"},
    DeviceLabel{ship::lever_astern, "lever astern"},
    DeviceLabel{ship::lever_stop, "lever stop"},
    DeviceLabel{ship::lever_ahead, "lever ahead"},
    DeviceLabel{ship::oil_pressure, "oil pressure"},
    DeviceLabel{ship::pump_1_runs, "pump 1 runs"},
    DeviceLabel{ship::pump_2_runs, "pump 2 runs"},
    DeviceLabel{ship::pump_1_protection, "pump 1 protection"},
    DeviceLabel{ship::pump_2_protection, "pump 2 protection"},
    DeviceLabel{ship::acknowledge_button, "acknowledge"},
    DeviceLabel{ship::local_switch, "local control"},
    DeviceLabel{ship::start_button, "start"},
    DeviceLabel{ship::stop_button, "stop"},
    DeviceLabel{ship::pumps_switch, "pumps on"},
};

template <std::size_t count>
constexpr auto with_plc(const std::array<DeviceLabel, count>& plant) {
  std::array<DeviceLabel, count + plc_labels.size()> all{};
  std::ranges::copy(plc_labels, std::ranges::copy(plant, all.begin()).out);
  return all;
}

constexpr auto all_of_machine_tool = with_plc(machine_tool_labels);
constexpr auto all_of_propulsion = with_plc(propulsion_labels);

}  // namespace

std::span<const DeviceLabel> labels_of(PlantKind plant) noexcept {
  switch (plant) {
    case PlantKind::machine_tool:
      return all_of_machine_tool;
    case PlantKind::propulsion:
      return all_of_propulsion;
    case PlantKind::none:
      break;
  }
  return plc_labels;
}

}  // namespace emulator_models
