// The PLC at its programming port: the worked examples, and what is refused or met with silence.
#include "emulator_models/fx_plc_emulator.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "tests/protocol/fx/worked_examples.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Command;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::Model;
using protocol::fx::Request;
using protocol::fx::examples::bytes;

constexpr Device m(std::uint16_t number) { return {DeviceKind::m, number}; }
constexpr Device d(std::uint16_t number) { return {DeviceKind::d, number}; }
constexpr Device y(std::uint16_t index) { return {DeviceKind::y, index}; }

const std::vector<std::byte> acknowledged = bytes("06");
const std::vector<std::byte> refused = bytes("15");
const std::vector<std::byte> silence;

std::vector<std::byte> ask(FxPlcEmulator& plc, std::string_view hex) {
  const auto answer = plc.process(bytes(hex));
  return {answer.begin(), answer.end()};
}

std::vector<std::byte> ask(FxPlcEmulator& plc, const Request& request) {
  const auto answer = plc.process(protocol::fx::as_span(encode(request)));
  return {answer.begin(), answer.end()};
}

Request write_request(std::uint16_t address, std::initializer_list<unsigned> data) {
  Request request{Command::write, address, static_cast<std::uint8_t>(data.size()), {}};
  for (const unsigned byte : data) request.data.push_back(static_cast<std::byte>(byte));
  return request;
}

unsigned value(FxPlcEmulator& plc, Device device) {
  return plc.with_memory([&](const DeviceMemory& memory) { return memory.get(device); });
}

void set(FxPlcEmulator& plc, Device device, unsigned to) {
  plc.with_memory([&](DeviceMemory& memory) { memory.set(device, to); });
}

void set_mode(FxPlcEmulator& plc, RunMode mode) {
  plc.with_memory([&](DeviceMemory& memory) { set_run_flags(memory, mode); });
}

TEST(FxPlcEmulator, answers_enq_with_ack) {
  FxPlcEmulator plc{Model::fx3u};
  EXPECT_EQ(ask(plc, "05"), acknowledged);
}

TEST(FxPlcEmulator, reads_outputs_and_inputs_as_the_worked_examples_do) {
  FxPlcEmulator plc{Model::fx1n};
  for (std::uint16_t i = 0; i < 6; ++i) set(plc, y(i), 1);
  EXPECT_EQ(ask(plc, "02 30 30 30 41 30 30 31 03 36 35"), bytes("02 33 46 03 37 43"));
  EXPECT_EQ(ask(plc, "02 30 30 30 41 30 30 32 03 36 36"), bytes("02 33 46 30 30 03 44 43"));
  set(plc, {DeviceKind::x, 15}, 1);  // X17
  EXPECT_EQ(ask(plc, "02 30 30 30 38 30 30 32 03 35 44"), bytes("02 30 30 38 30 03 43 42"));
}

TEST(FxPlcEmulator, writes_and_reads_two_registers_as_the_captured_session_did) {
  FxPlcEmulator plc{Model::fx1n};
  EXPECT_EQ(ask(plc, "02 31 31 30 46 36 30 34 33 34 31 32 43 44 41 42 03 34 39"), acknowledged);
  EXPECT_EQ(value(plc, d(123)), 0x1234U);
  EXPECT_EQ(value(plc, d(124)), 0xABCDU);
  EXPECT_EQ(ask(plc, "02 30 31 30 46 36 30 34 03 37 34"), bytes("02 33 34 31 32 43 44 41 42 03 44 37"));
}

TEST(FxPlcEmulator, tells_run_and_stop_as_captured) {
  FxPlcEmulator plc{Model::fx1n};
  const auto* const legacy = "02 30 30 31 45 30 30 31 03 36 41";
  const auto* const wide_fx1n = "02 45 30 30 30 31 43 30 30 31 03 44 44";
  set_mode(plc, RunMode::run);
  EXPECT_EQ(ask(plc, legacy), bytes("02 30 39 03 36 43"));
  EXPECT_EQ(ask(plc, wide_fx1n), bytes("02 30 39 03 36 43"));
  set_mode(plc, RunMode::stop);
  EXPECT_EQ(ask(plc, legacy), bytes("02 30 41 03 37 34"));
}

TEST(FxPlcEmulator, tells_its_type_and_version_as_captured) {
  const struct {
    Model model;
    const char* reply;
  } units[] = {{Model::fx1n, "02 36 32 36 36 03 44 37"},
               {Model::fx1s, "02 43 32 35 36 03 45 33"},
               {Model::fx2n, "02 42 31 35 45 03 46 30"},
               {Model::fx3u, "02 42 31 35 45 03 46 30"}};
  for (const auto& unit : units) {
    FxPlcEmulator plc{unit.model};
    EXPECT_EQ(ask(plc, "02 30 30 45 30 32 30 32 03 36 43"), bytes(unit.reply)) << to_string(unit.model);
  }
  FxPlcEmulator fx3u{Model::fx3u};
  EXPECT_EQ(ask(fx3u, "02 30 30 45 43 41 30 32 03 38 45"), bytes("02 37 31 33 46 03 45 34"));
}

TEST(FxPlcEmulator, reads_timer_and_counter_values_of_16_and_32_bits) {
  FxPlcEmulator plc{Model::fx2n};
  set(plc, {DeviceKind::t_value, 10}, 0x00FF);
  set(plc, {DeviceKind::c_value, 200}, 0x1234'5678);
  EXPECT_EQ(ask(plc, "02 30 30 38 31 34 30 32 03 36 32"), bytes("02 46 46 30 30 03 45 46"));
  EXPECT_EQ(ask(plc, "02 30 30 43 30 30 30 34 03 36 41"), bytes("02 37 38 35 36 33 34 31 32 03 41 37"));
}

TEST(FxPlcEmulator, reads_64_bytes_at_once) {
  FxPlcEmulator plc{Model::fx1n};
  EXPECT_EQ(ask(plc, "02 30 31 30 30 30 34 30 03 35 38").size(), 4U + 2U * 64U);
}

TEST(FxPlcEmulator, writes_the_watchdog_time) {
  FxPlcEmulator plc{Model::fx3u};
  EXPECT_EQ(ask(plc, "02 31 30 45 30 30 30 32 32 43 30 31 03 34 31"), acknowledged);
  EXPECT_EQ(value(plc, d(8000)), 300U);
}

TEST(FxPlcEmulator, forces_bits_as_the_worked_examples_do) {
  FxPlcEmulator plc{Model::fx3u};
  const struct {
    const char* on;
    const char* off;  ///< nullptr: no such example
    Device device;
  } forces[] = {
      {"02 37 30 30 30 35 03 46 46", "02 38 30 30 30 35 03 30 30", y(0)},
      {"02 37 31 30 30 35 03 30 30", nullptr, y(16)},
      {"02 37 36 34 30 38 03 30 43", "02 38 36 34 30 38 03 30 44", m(100)},
      {"02 37 30 30 30 30 03 46 41", nullptr, {DeviceKind::s, 0}},
      {"02 37 32 35 30 46 03 31 37", nullptr, m(8037)},
      {"02 45 37 30 30 34 30 03 34 33", "02 45 38 30 30 34 30 03 34 34", m(0)},
  };
  for (const auto& force : forces) {
    SCOPED_TRACE(force.on);
    EXPECT_EQ(ask(plc, force.on), acknowledged);
    EXPECT_EQ(value(plc, force.device), 1U);
    if (force.off == nullptr) continue;
    EXPECT_EQ(ask(plc, force.off), acknowledged);
    EXPECT_EQ(value(plc, force.device), 0U);
  }
  EXPECT_EQ(ask(plc, "02 45 37 30 30 35 45 03 35 39"), acknowledged);
  EXPECT_EQ(value(plc, y(0)), 1U);
}

TEST(FxPlcEmulator, reads_and_writes_the_wide_space_of_fx3u_as_captured) {
  FxPlcEmulator plc{Model::fx3u};
  set(plc, d(0), 0x0201);
  EXPECT_EQ(ask(plc, "02 45 30 30 34 30 30 30 30 32 03 43 45"), bytes("02 30 31 30 32 03 43 36"));
  EXPECT_EQ(ask(plc, "02 45 31 30 34 30 43 38 30 32 30 32 30 31 03 41 44"), acknowledged);
  EXPECT_EQ(value(plc, d(100)), 258U);
  EXPECT_EQ(ask(plc, "02 45 30 30 38 30 46 45 30 32 03 46 44"), bytes("02 30 30 30 30 03 43 33"));
}

TEST(FxPlcEmulator, refuses_the_parameter_area_and_the_end_of_a_program_write) {
  FxPlcEmulator plc{Model::fx1s};
  EXPECT_EQ(ask(plc, "02 30 38 30 30 30 32 45 03 37 32"), refused);
  EXPECT_EQ(ask(plc, "02 42 03 34 35"), refused);
}

// What follows are the project's choices (README.md).

struct Defect {
  const char* what;
  const char* frame;
  unsigned d8062;
};

TEST(FxPlcEmulator, refuses_a_damaged_frame_and_notes_why) {
  const Defect defects[] = {
      {"wrong sum", "02 30 31 30 46 36 30 34 03 37 35", 6203},
      {"sum in lower case", "02 37 30 30 30 35 03 66 66", 6203},
      {"unknown command 2", "02 32 03 33 35", 6205},
      {"E01, parameters", "02 45 30 31 38 30 35 43 32 45 03 30 30", 6205},
      {"A1, line speed", "02 41 31 03 37 35", 6205},
      {"too short", "02 30 31 30 46 36 30 03 34 30", 6204},
      {"lower-case digit", "02 30 31 30 66 36 30 34 03 39 34", 6202},
      {"count 0", "02 30 31 30 46 36 30 30 03 37 30", 6204},
      {"count 65", "02 30 31 30 30 30 34 31 03 35 39", 6204},
  };
  for (const Defect& defect : defects) {
    SCOPED_TRACE(defect.what);
    FxPlcEmulator plc{Model::fx3u};
    EXPECT_EQ(ask(plc, defect.frame), refused);
    EXPECT_EQ(value(plc, m(8062)), 1U);
    EXPECT_EQ(value(plc, d(8062)), defect.d8062);
  }
}

TEST(FxPlcEmulator, stays_silent_when_no_whole_frame_came) {
  FxPlcEmulator plc{Model::fx3u};
  for (const auto* message : {"", "06", "15", "30", "02", "02 30 31 30", "05 05", "05 02 30 39 03 36 43"})
    EXPECT_EQ(ask(plc, message), silence) << message;
  EXPECT_EQ(value(plc, m(8062)), 0U);
}

TEST(FxPlcEmulator, a_refusal_stays_noted_until_the_port_clears_it) {
  FxPlcEmulator plc{Model::fx3u};
  ask(plc, "02 32 03 33 35");
  EXPECT_EQ(ask(plc, "05"), acknowledged);
  EXPECT_EQ(value(plc, m(8062)), 1U);
  EXPECT_EQ(ask(plc, Request{Command::force_off, 0x0F3E, 0, {}}), acknowledged);  // M8062
  EXPECT_EQ(value(plc, m(8062)), 0U);
}

TEST(FxPlcEmulator, an_fx1s_does_not_know_the_e_commands) {
  FxPlcEmulator plc{Model::fx1s};
  EXPECT_EQ(ask(plc, "02 45 30 30 34 30 30 30 30 32 03 43 45"), refused);
  EXPECT_EQ(ask(plc, "02 45 37 30 30 34 30 03 34 33"), refused);
  EXPECT_EQ(value(plc, d(8062)), 6205U);
}

TEST(FxPlcEmulator, refuses_addresses_without_a_device) {
  FxPlcEmulator plc{Model::fx1s};
  EXPECT_EQ(ask(plc, Request{Command::read, 0x11FE, 2, {}}).size(), 8U);    // D255
  EXPECT_EQ(ask(plc, Request{Command::read, 0x1200, 2, {}}), refused);      // D256
  EXPECT_EQ(ask(plc, Request{Command::force_on, 0x050E, 0, {}}), refused);  // Y16
  EXPECT_EQ(value(plc, d(8062)), 6205U);
}

TEST(FxPlcEmulator, a_range_that_leaves_the_devices_is_refused_as_a_whole) {
  FxPlcEmulator plc{Model::fx1s};
  EXPECT_EQ(ask(plc, write_request(0x11FE, {1, 2, 3, 4})), refused);
  EXPECT_EQ(value(plc, d(255)), 0U);
  EXPECT_EQ(ask(plc, Request{Command::read, 0xFFFF, 2, {}}), refused);
}

TEST(FxPlcEmulator, a_range_may_go_on_into_the_area_next_to_it) {
  FxPlcEmulator plc{Model::fx3u};
  set(plc, y(255), 1);                      // Y377, byte 00BF
  set(plc, {DeviceKind::t_contact, 0}, 1);  // byte 00C0
  EXPECT_EQ(ask(plc, Request{Command::read, 0x00BF, 2, {}}), bytes("02 38 30 30 31 03 43 43"));
}

TEST(FxPlcEmulator, words_may_be_read_and_written_by_the_byte) {
  FxPlcEmulator plc{Model::fx3u};
  set(plc, d(0), 0x1234);
  EXPECT_EQ(ask(plc, write_request(0x1001, {0xAB})), acknowledged);
  EXPECT_EQ(value(plc, d(0)), 0xAB34U);
  EXPECT_EQ(ask(plc, Request{Command::read, 0x1001, 1, {}}), bytes("02 41 42 03 38 36"));
}

TEST(FxPlcEmulator, inputs_and_contacts_may_be_written_and_forced) {
  FxPlcEmulator plc{Model::fx3u};
  EXPECT_EQ(ask(plc, write_request(0x0080, {0x01})), acknowledged);
  EXPECT_EQ(value(plc, {DeviceKind::x, 0}), 1U);
  EXPECT_EQ(ask(plc, Request{Command::force_on, 0x0601, 0, {}}), acknowledged);
  EXPECT_EQ(value(plc, {DeviceKind::t_contact, 1}), 1U);
  EXPECT_EQ(ask(plc, Request{Command::force_on, 0x0E01, 0, {}}), acknowledged);
  EXPECT_EQ(value(plc, {DeviceKind::c_contact, 1}), 1U);
}

TEST(FxPlcEmulator, coils_and_resets_of_timers_and_counters_are_refused) {
  FxPlcEmulator plc{Model::fx3u};
  for (const std::uint16_t coil : std::initializer_list<std::uint16_t>{0x1600, 0x1E00, 0x2600, 0x2E00})
    EXPECT_EQ(ask(plc, Request{Command::force_on, coil, 0, {}}), refused) << coil;
}

TEST(FxPlcEmulator, read_only_devices_are_refused_and_a_write_across_one_changes_nothing) {
  FxPlcEmulator plc{Model::fx3u};
  EXPECT_EQ(ask(plc, write_request(0x0E00, {0x2C, 0x01, 0x00, 0x00})), refused);  // D8000 with D8001
  EXPECT_EQ(value(plc, d(8000)), 200U);
  EXPECT_EQ(ask(plc, Request{Command::force_on, 0x0F00, 0, {}}), refused);  // M8000
  EXPECT_EQ(value(plc, m(8000)), 0U);
  EXPECT_EQ(ask(plc, write_request(0x01E0, {0xFF})), refused);  // M8000 to M8007
  EXPECT_EQ(value(plc, d(8062)), 6205U);
}

TEST(FxPlcEmulator, a_snapshot_is_a_copy) {
  FxPlcEmulator plc{Model::fx3u};
  const DeviceMemory before = plc.snapshot();
  ask(plc, "02 37 30 30 30 35 03 46 46");
  EXPECT_EQ(before.get(y(0)), 0U);
  EXPECT_TRUE(plc.read_bit(y(0)));
  EXPECT_EQ(plc.read_word(d(8000)), 200U);
}

}  // namespace
}  // namespace emulator_models
