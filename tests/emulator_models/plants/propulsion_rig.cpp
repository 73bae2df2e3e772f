#include "tests/emulator_models/plants/propulsion_rig.hpp"

#include <cstring>
#include <sstream>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/latched_ranges.hpp"
#include "emulator_models/programs/propulsion_program.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"

#include <gtest/gtest.h>

namespace emulator_models {

using namespace std::chrono_literals;

std::string program_without(std::string_view rule) {
  std::istringstream source{std::string{propulsion_program()}};
  std::string mark{"(* rule: "};
  mark.append(rule).append(" *)");
  std::string kept;
  for (std::string line; std::getline(source, line);) {
    if (rule.empty() || line.find(mark) == std::string::npos) kept += line;
    kept += '\n';
  }
  return kept;
}

PropulsionRig::PropulsionRig(std::string_view rule_left_out) {
  const auto compiled =
      soft_plc::compile(program_without(rule_left_out), FxAddressMap{protocol::fx::Model::fx3u});
  if (!compiled) {
    ADD_FAILURE() << compiled.error().place.line << ": " << compiled.error().message;
    return;
  }
  program_ = *compiled;
  machine_ = std::make_unique<soft_plc::IlMachine>(program_);
}

void PropulsionRig::scan() {
  if (!machine_) return;
  now_ += scan_period;
  if (heartbeat) set_word(propulsion::pc_heartbeat, (word(propulsion::pc_heartbeat) + 1) % 1000);
  plant.advance(terminals, now_);
  copy_points(terminals.inputs, devices_.inputs());
  std::memcpy(devices_.bytes().data() + devices_.place_of(propulsion::lever_word).byte_index,
              terminals.analog_inputs.data(), sizeof terminals.analog_inputs);
  const auto done =
      machine_->run_scan({devices_.inputs(), devices_.outputs(), devices_.bytes()}, now_.time_since_epoch());
  ASSERT_TRUE(done.has_value()) << to_string(done.error());
  terminals.outputs = points_of(devices_.outputs());
  std::memcpy(terminals.analog_outputs.data(),
              devices_.bytes().data() + devices_.place_of(propulsion::torque_word).byte_index,
              sizeof terminals.analog_outputs);
  rules.observe(terminals, contract(), now_);
}

void PropulsionRig::scan_for(std::chrono::milliseconds time) {
  for (auto passed = 0ms; passed < time; passed += scan_period) scan();
}

void PropulsionRig::start() {
  scan_for(100ms);
  plant.set_pumps_switch(true);
  scan_for(2200ms);
  press_start();
  scan_for(1s);
}

void PropulsionRig::give_control_to_station() {
  set(propulsion::pc_remote, true);
  scan();
}

void PropulsionRig::press_acknowledge() {
  plant.press_acknowledge(true);
  scan();
  plant.press_acknowledge(false);
}

void PropulsionRig::press_start() {
  plant.press_start(true);
  scan();
  plant.press_start(false);
}

void PropulsionRig::stop_and_run_plc() {
  terminals.outputs.reset();
  terminals.analog_outputs.fill(0);
  clear_unlatched(devices_);
  machine_->start(soft_plc::IlMachine::Start::warm);
  rules.run_begins();
}

bool PropulsionRig::on(propulsion::Device m) const { return devices_.get(m) != 0; }

int PropulsionRig::word(propulsion::Device d) const { return static_cast<std::int16_t>(devices_.get(d)); }

void PropulsionRig::set(propulsion::Device m, bool value) { devices_.set(m, value); }

void PropulsionRig::set_word(propulsion::Device d, int value) {
  devices_.set(d, static_cast<std::uint16_t>(value));
}

std::string PropulsionRig::broken_rules() const {
  std::string names;
  for (std::size_t i = 0; i < propulsion_rules_count; ++i)
    if (rules.broken()[i]) names.append(" ").append(name_of(static_cast<PropulsionRule>(i)));
  return names;
}

PropulsionContract PropulsionRig::contract() const {
  PropulsionContract shown;
  for (std::size_t i = 0; i < PropulsionContract::count; ++i) {
    const auto number = static_cast<std::uint16_t>(PropulsionContract::first + i);
    shown.bits[i] = on({propulsion::DeviceKind::m, number});
    shown.words[i] = static_cast<std::int16_t>(word({propulsion::DeviceKind::d, number}));
  }
  return shown;
}

}  // namespace emulator_models
