// The devices that the PLC itself writes. Values come from captures of real units.
#include "emulator_models/special_devices.hpp"

#include <gtest/gtest.h>

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::AddressSpace;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::Model;

constexpr Device m(int number) { return {DeviceKind::m, static_cast<std::uint16_t>(number)}; }
constexpr Device d(int number) { return {DeviceKind::d, static_cast<std::uint16_t>(number)}; }

std::byte run_state(const DeviceMemory& memory) {
  return memory.read_byte(0x01E0, AddressSpace::legacy).value_or(std::byte{0xFF});
}

TEST(SpecialDevices, type_and_version_are_those_of_captured_units) {
  const struct {
    Model model;
    unsigned d8001;
  } units[] = {{Model::fx1s, 22210}, {Model::fx1n, 26210}, {Model::fx2n, 24241}, {Model::fx3u, 24241}};
  for (const auto& unit : units) {
    DeviceMemory memory{unit.model};
    set_power_up_values(memory);
    EXPECT_EQ(memory.get(d(8001)), unit.d8001) << to_string(unit.model);
    EXPECT_EQ(memory.get(d(8101)), unit.model == Model::fx3u ? 16241U : 0U) << to_string(unit.model);
    EXPECT_EQ(memory.get(d(8000)), 200U);
    EXPECT_EQ(run_state(memory), std::byte{0x0A});
  }
}

TEST(SpecialDevices, the_run_state_byte_is_0A_in_stop_05_in_the_first_scan_and_09_in_run) {
  DeviceMemory memory{Model::fx1n};
  set_run_flags(memory, RunMode::stop);
  EXPECT_EQ(run_state(memory), std::byte{0x0A});
  set_run_flags(memory, RunMode::first_run_scan);
  EXPECT_EQ(run_state(memory), std::byte{0x05});
  set_run_flags(memory, RunMode::run);
  EXPECT_EQ(run_state(memory), std::byte{0x09});
}

TEST(SpecialDevices, clocks_are_off_in_the_first_half_of_their_period_and_on_in_the_second) {
  DeviceMemory memory{Model::fx3u};
  const struct {
    std::uint16_t number;
    std::chrono::nanoseconds period;
  } clocks[] = {{8011, 10ms}, {8012, 100ms}, {8013, 1s}, {8014, 1min}};
  for (const auto& clock : clocks) {
    for (const auto start : {0 * clock.period, 7 * clock.period}) {
      set_clock_flags(memory, start);
      EXPECT_EQ(memory.get(m(clock.number)), 0U);
      set_clock_flags(memory, start + clock.period / 2 - 1ns);
      EXPECT_EQ(memory.get(m(clock.number)), 0U);
      set_clock_flags(memory, start + clock.period / 2);
      EXPECT_EQ(memory.get(m(clock.number)), 1U);
    }
  }
}

TEST(SpecialDevices, the_calendar_counts_as_the_captured_unit_did) {
  DeviceMemory memory{Model::fx3u};
  using namespace std::chrono;
  set_calendar(memory, sys_days{2025y / August / 8} + 16h + 31min + 49s + 999ms);
  const unsigned wanted[] = {49, 31, 16, 8, 8, 2025, 5};
  for (std::uint16_t i = 0; i < 7; ++i)
    EXPECT_EQ(memory.get(d(static_cast<std::uint16_t>(8013 + i))), wanted[i]) << 8013 + i;
}

TEST(SpecialDevices, remote_run_needs_both_bits) {
  DeviceMemory memory{Model::fx3u};
  EXPECT_FALSE(obey_remote_switch(memory, false));
  memory.set(m(8035), 1);
  EXPECT_FALSE(obey_remote_switch(memory, false));
  memory.set(m(8036), 1);
  EXPECT_TRUE(obey_remote_switch(memory, false));
}

TEST(SpecialDevices, remote_stop_wins_over_remote_run_and_clears_the_order) {
  DeviceMemory memory{Model::fx3u};
  for (const int number : {8035, 8036, 8037}) memory.set(m(number), 1);
  EXPECT_FALSE(obey_remote_switch(memory, true));
  for (const int number : {8035, 8036, 8037}) EXPECT_EQ(memory.get(m(number)), 0U);
}

TEST(SpecialDevices, port_trouble_is_kept_with_its_code) {
  DeviceMemory memory{Model::fx3u};
  note_port_trouble(memory, PortTrouble::bad_checksum);
  EXPECT_EQ(memory.get(m(8062)), 1U);
  EXPECT_EQ(memory.get(d(8062)), 6203U);
}

TEST(SpecialDevices, what_the_plc_writes_itself_is_read_only) {
  for (const int number : {8000, 8003, 8011, 8014}) EXPECT_TRUE(is_read_only(m(number), Model::fx3u));
  for (const int number : {8001, 8010, 8019, 8101}) EXPECT_TRUE(is_read_only(d(number), Model::fx3u));
  for (const int number : {0, 8004, 8010, 8015, 8034, 8037, 8062})
    EXPECT_FALSE(is_read_only(m(number), Model::fx3u)) << number;
  for (const int number : {0, 8000, 8002, 8009, 8020, 8062})
    EXPECT_FALSE(is_read_only(d(number), Model::fx3u)) << number;
  EXPECT_FALSE(is_read_only(d(8101), Model::fx1n));
}

}  // namespace
}  // namespace emulator_models
