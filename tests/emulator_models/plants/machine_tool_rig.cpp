#include "tests/emulator_models/plants/machine_tool_rig.hpp"

#include "emulator_models/fx_address_map.hpp"

#include <gtest/gtest.h>

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using machine_tool::Y;
using protocol::fx::DeviceKind;

constexpr std::uint16_t analog_inputs_word = 200;
constexpr std::uint16_t analog_outputs_word = 210;

soft_plc::IlProgram compiled(std::string_view source) {
  auto program = soft_plc::compile(source, FxAddressMap{protocol::fx::Model::fx3u});
  EXPECT_TRUE(program.has_value()) << to_string(program.error());
  return std::move(*program);
}

}  // namespace

MachineToolRig::MachineToolRig(std::string_view source, std::chrono::nanoseconds period)
    : program_{compiled(source)}, machine_{program_}, period_{period} {
  set_m(103, true);
  set_m(107, true);
  set_d(analog_outputs_word, 3000);
}

void MachineToolRig::scan() {
  plant.advance(terminals, now);
  copy_points(terminals.inputs, devices_.inputs());
  for (std::uint16_t i = 0; i < Terminals::analogs_count; ++i)
    set_d(analog_inputs_word + i, terminals.analog_inputs[i]);
  const auto executed =
      machine_.run_scan({devices_.inputs(), devices_.outputs(), devices_.bytes()}, now.time_since_epoch());
  ASSERT_TRUE(executed.has_value()) << to_string(executed.error());
  instructions_of_last_scan = *executed;
  terminals.outputs = points_of(devices_.outputs());
  for (std::uint16_t i = 0; i < Terminals::analogs_count; ++i) {
    terminals.analog_outputs[i] = static_cast<std::uint16_t>(d(analog_outputs_word + i));
  }
  const MachineToolContract contract{.m_code = static_cast<std::uint16_t>(d(100)),
                                     .selected_tool = static_cast<std::uint16_t>(d(220)),
                                     .warning_number = static_cast<std::uint16_t>(d(121)),
                                     .m_strobe = m(100),
                                     .s_strobe = m(101),
                                     .t_strobe = m(102),
                                     .distribution_end = m(103),
                                     .reset = m(105),
                                     .z_at_change = m(107),
                                     .fin = m(120),
                                     .alarm = m(121),
                                     .feed_enable = m(125),
                                     .plc_runs = true};
  const MachineToolRules::Broken found = rules_.look(terminals, plant, contract, now);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found.test(i)) broken.emplace(name_of(static_cast<MachineToolRule>(i)));
  }
  now += period_;
}

void MachineToolRig::run_for(std::chrono::nanoseconds duration) {
  const SteadyTime end = now + duration;
  do scan();
  while (now < end);
}

void MachineToolRig::reset() {
  set_m(105, true);
  run_for(100ms);
  set_m(105, false);
  run_for(50ms);
}

void MachineToolRig::switch_on() {
  run_for(50ms);
  reset();
  run_for(13s);
}

void MachineToolRig::give(int m_code) {
  set_d(100, m_code);
  set_m(100, true);
}
void MachineToolRig::give_s(int speed) {
  set_d(101, speed);
  set_m(101, true);
}
void MachineToolRig::give_t(int tool) {
  set_d(102, tool);
  set_m(102, true);
}

void MachineToolRig::take_back_strobes() {
  for (std::uint16_t strobe = 100; strobe <= 102; ++strobe) set_m(strobe, false);
  run_for(2 * period_);
}

std::chrono::milliseconds MachineToolRig::wait_for_fin() {
  const SteadyTime begin = now;
  do scan();
  while (!m(120) && now - begin < 30s);
  const auto time = std::chrono::duration_cast<std::chrono::milliseconds>(now - begin);
  take_back_strobes();
  return time;
}

std::chrono::milliseconds MachineToolRig::execute(int m_code) {
  give(m_code);
  return wait_for_fin();
}
std::chrono::milliseconds MachineToolRig::select_tool(int tool) {
  give_t(tool);
  return wait_for_fin();
}
std::chrono::milliseconds MachineToolRig::set_speed(int speed) {
  give_s(speed);
  return wait_for_fin();
}

bool MachineToolRig::m(std::uint16_t number) const { return devices_.get({DeviceKind::m, number}) != 0; }
void MachineToolRig::set_m(std::uint16_t number, bool on) { devices_.set({DeviceKind::m, number}, on); }
int MachineToolRig::d(std::uint16_t number) const {
  return static_cast<int>(devices_.get({DeviceKind::d, number}));
}
void MachineToolRig::set_d(std::uint16_t number, int value) {
  devices_.set({DeviceKind::d, number}, static_cast<std::uint16_t>(value));
}

bool MachineToolRig::moves_nothing() const {
  for (std::size_t i = index_of(Y::spindle_clockwise); i <= index_of(Y::tool_unclamp); ++i) {
    if (i != index_of(Y::hydraulic_pump) && terminals.outputs.test(i)) return false;
  }
  return true;
}

void MachineToolRig::restart() { machine_.start(soft_plc::IlMachine::Start::cold); }

}  // namespace emulator_models
