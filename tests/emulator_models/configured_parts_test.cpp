// What stands around a configured soft PLC in plc-emulator: drivers, the programming port, the report.
#include <gtest/gtest.h>

#include <map>

#include "emulator_models/configured_port.hpp"
#include "emulator_models/cycle_report.hpp"
#include "emulator_models/plant_drivers.hpp"
#include "emulator_models/plants/machine_tool_wiring.hpp"
#include "protocol/fx/frame.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using namespace soft_plc;
using protocol::fx::Command;
using protocol::fx::FrameBytes;

ConfiguredDriver driver_of(std::string kind, Section inputs, std::vector<std::byte> fixed = {}) {
  ConfiguredDriver driver;
  driver.kind = std::move(kind);
  driver.config.inputs = inputs;
  driver.fixed_inputs = std::move(fixed);
  return driver;
}

struct Wired {
  OutputGate gate{{}};
  std::uint64_t run = gate.open(false);
  std::unique_ptr<IoDriver> driver;
  std::vector<std::byte> inputs;

  Wired(const ConfiguredDriver& configured)
      : driver{make_driver(configured)}, inputs(configured.config.inputs.bytes, std::byte{0xEE}) {}

  void exchange(const OutputGate::Outputs& outputs) {
    const std::vector<std::byte> all(outputs.size(), std::byte{0xFF});
    ASSERT_TRUE(gate.commit(run, all, outputs));
    ASSERT_TRUE(driver->exchange(gate.frame(), gate, inputs));
  }
};

TEST(PlantDrivers, the_simulated_field_answers_each_output_on_the_input_of_its_number) {
  Wired wired{driver_of("simulated", {4, 2})};
  OutputGate::Outputs outputs{};
  outputs[3] = std::byte{1};
  outputs[4] = std::byte{0x5A};
  outputs[5] = std::byte{0xA5};
  wired.exchange(outputs);
  EXPECT_EQ(wired.inputs, (std::vector{std::byte{0x5A}, std::byte{0xA5}}));
}

TEST(PlantDrivers, fixed_inputs_are_what_the_outputs_are_not) {
  Wired wired{driver_of("simulated", {0, 2}, {std::byte{3}, std::byte{4}})};
  OutputGate::Outputs outputs{};
  outputs.fill(std::byte{0xFF});
  wired.exchange(outputs);
  EXPECT_EQ(wired.inputs, (std::vector{std::byte{3}, std::byte{4}}));
}

bool input(const Wired& wired, machine_tool::X x) {
  return (wired.inputs[machine_tool::index_of(x) / 8] >> machine_tool::index_of(x) % 8 & std::byte{1}) !=
         std::byte{0};
}

TEST(PlantDrivers, the_machine_tool_stands_behind_the_terminals_from_the_first_byte_of_the_section_on) {
  Wired wired{driver_of("machine-tool", {8, 48})};
  OutputGate::Outputs outputs{};
  wired.exchange(outputs);
  EXPECT_TRUE(input(wired, machine_tool::X::spindle_zero_speed));
  EXPECT_FALSE(input(wired, machine_tool::X::contactor_on));
  // Y20: byte 2 of the section, bit 0.
  outputs[8 + 2] = std::byte{1};
  for (int i = 0; i < 100'000 && !input(wired, machine_tool::X::contactor_on); ++i) wired.exchange(outputs);
  EXPECT_TRUE(input(wired, machine_tool::X::contactor_on));
}

TEST(PlantDrivers, a_section_that_is_short_or_ends_with_the_area_does_no_harm) {
  for (const char* const kind : {"machine-tool", "propulsion", "simulated"}) {
    for (const Section section : {Section{0, 0}, Section{0, 1}, Section{0, 33}, Section{250, 6}}) {
      Wired wired{driver_of(kind, section)};
      wired.exchange({});
    }
  }
}

TEST(PlantDrivers, there_is_no_other_kind) { EXPECT_EQ(make_driver(driver_of("profibus", {0, 1})), nullptr); }

const std::string configuration =
    "[plc]\n"
    "[[cycle]]\nname = \"a\"\nprogram = \"a.il\"\nperiod_ms = 1\n"
    "[[cycle]]\nname = \"b\"\nprogram = \"a.il\"\nperiod_ms = 1\nsends = { first_word = 500, words = 1 }\n";

std::optional<std::string> read_source(const std::string& /*path*/) {
  return "PROGRAM p\nVAR q AT %QX1.1 : BOOL; END_VAR\nEND_PROGRAM\n";
}

/// The port of a PLC whose one program sets nothing, in STOP.
struct Port : testing::Test {
  SteadyPlcClock clock;
  ConfiguredPlc plc{"plc.toml", read_source, make_driver, clock};
  ConfigurationService configuration_service{[this](std::string_view text) { return plc.reload(text, {}); }};
  ConfiguredPort port{plc, configuration_service};

  Port() {
    const auto loaded = plc.reload(configuration);
    EXPECT_TRUE(loaded) << loaded.error();
  }

  FrameBytes ask(const protocol::fx::Request& request) {
    return port.process(protocol::fx::as_span(protocol::fx::encode(request)));
  }
  /// Read or write of devices by name.
  static protocol::fx::Request of(Command command, const char* device, std::vector<std::uint8_t> bytes,
                                  std::uint8_t count = 0) {
    using namespace protocol::fx;
    const auto space = is_wide(command) ? AddressSpace::wide : AddressSpace::legacy;
    const Device found = parse_device(device, Model::fx3u).value();
    const bool is_force = command == Command::force_on || command == Command::force_off;
    Request request{.command = command,
                    .address = (is_force ? bit_number(found, Model::fx3u, space)
                                         : byte_address(found, Model::fx3u, space))
                                   .value(),
                    .count_bytes = count,
                    .data = {}};
    for (const std::uint8_t byte : bytes) request.data.push_back(std::byte{byte});
    if (!bytes.empty()) request.count_bytes = static_cast<std::uint8_t>(bytes.size());
    return request;
  }
  std::vector<std::uint8_t> read(const char* device, std::uint8_t count) {
    const FrameBytes answer = ask(of(Command::read, device, {}, count));
    const auto bytes = protocol::fx::decode_data_reply(protocol::fx::as_span(answer));
    std::vector<std::uint8_t> values;
    if (bytes) {
      for (const std::byte byte : *bytes) values.push_back(std::to_integer<std::uint8_t>(byte));
    }
    return values;
  }
  /// @return "ACK", "NAK", "silence" or "data"
  std::string answer(const protocol::fx::Request& request) {
    const FrameBytes bytes = ask(request);
    if (bytes.empty()) return "silence";
    if (bytes.size() > 1) return "data";
    return bytes[0] == protocol::fx::ack ? "ACK" : "NAK";
  }
};

using ConfiguredPortTest = Port;

TEST_F(ConfiguredPortTest, D_is_MW_and_M_lies_behind_the_last_D) {
  EXPECT_EQ(answer(of(Command::write, "D100", {0x34, 0x12, 0x78, 0x56})), "ACK");
  EXPECT_EQ(read("D100", 4), (std::vector<std::uint8_t>{0x34, 0x12, 0x78, 0x56}));
  EXPECT_EQ(answer(of(Command::write, "M16", {0x0F})), "ACK");
  const auto seen = plc.plc()->gateway().exchange(
      {.cycle = 0, .items = {{.section = {200, 4}, .written = {}}, {.section = {16'002, 1}, .written = {}}}},
      10s);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->read[0][1], std::byte{0x12});
  EXPECT_EQ(seen->read[1][0], std::byte{0x0F});
}

TEST_F(ConfiguredPortTest, a_forced_M_leaves_its_neighbours_alone) {
  ASSERT_EQ(answer(of(Command::write, "M8", {0x81})), "ACK");
  EXPECT_EQ(answer(of(Command::force_on, "M10", {})), "ACK");
  EXPECT_EQ(answer(of(Command::force_off, "M15", {})), "ACK");
  EXPECT_EQ(read("M8", 1), std::vector<std::uint8_t>{0x05});
}

TEST_F(ConfiguredPortTest, X_and_Y_can_be_read_and_not_written) {
  EXPECT_EQ(read("X0", 2), (std::vector<std::uint8_t>{0, 0}));
  EXPECT_EQ(read("Y10", 1), std::vector<std::uint8_t>{0});
  EXPECT_EQ(answer(of(Command::write, "Y0", {1})), "NAK");
  EXPECT_EQ(answer(of(Command::force_on, "Y0", {})), "NAK");
}

TEST_F(ConfiguredPortTest, words_of_other_cycles_and_devices_that_are_not_there_are_refused) {
  EXPECT_EQ(answer(of(Command::write, "D500", {1, 0})), "NAK");
  EXPECT_EQ(read("D500", 2).size(), 2U);
  EXPECT_EQ(answer(of(Command::read, "D8000", {}, 2)), "NAK");
  EXPECT_EQ(answer(of(Command::read, "M8000", {}, 1)), "NAK");
  EXPECT_EQ(answer(of(Command::read, "S0", {}, 1)), "NAK");
}

TEST_F(ConfiguredPortTest, ENQ_is_answered_and_noise_is_not) {
  const std::byte enq = protocol::fx::enq;
  EXPECT_EQ(port.process({&enq, 1})[0], protocol::fx::ack);
  const std::byte noise{0x41};
  EXPECT_TRUE(port.process({&noise, 1}).empty());
  FrameBytes damaged = protocol::fx::encode(of(Command::read, "D0", {}, 2));
  damaged.back() = std::byte{'!'};
  EXPECT_EQ(port.process(protocol::fx::as_span(damaged))[0], protocol::fx::nak);
}

TEST(CycleReport, shows_each_range_up_to_the_latest_start_and_all_counts) {
  StartDelays delays;
  for (int i = 0; i < 998; ++i) delays.add(3us);
  delays.add(30us);
  delays.add(2s);
  CycleStatus status;
  status.overruns_count = 3;
  status.lost_starts_count = 4;
  status.scan_times.add(1500ns);
  const std::string text = cycle_report("fast", 1ms, status, delays);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "cycle fast, every 1 ms: 1000 scans begun in RUN, 3 overruns, 4 lost starts");
  EXPECT_NE(text.find("  < 10 us                  998  99.8000 %\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  < 20 us                    0   0.0000 %\n"), std::string::npos);
  EXPECT_NE(text.find("  < 50 us                    1   0.1000 %\n"), std::string::npos);
  EXPECT_NE(text.find("  more                       1   0.1000 %\n"), std::string::npos);
  EXPECT_NE(text.find("late: median 4 us, 99 % 4 us, 99.9 % 32 us, most 2 s\n"), std::string::npos) << text;
  EXPECT_NE(text.find("shortest 1.5 us, mean 1.5 us, longest 1.5 us\n"), std::string::npos);
}

TEST(CycleReport, shows_real_time_values_with_their_scan_a_bit_as_it_is_a_word_in_both_ways) {
  RealTimeReading reading{
      .outcome = ReadOutcome::read, .stamp = {.scan_number = 12, .time = 1500ms}, .values = {1, 0xFFFF, 7}};
  EXPECT_EQ(values_report("fast", {"%QX0.3", "%MW0", "%MD1"}, reading),
            "values of cycle fast after scan 12, at 1.500 s: %QX0.3 = 1, %MW0 = 65535 (16#FFFF), %MD1 = 7 "
            "(16#00000007)\n");
  reading.outcome = ReadOutcome::nothing_published;
  EXPECT_EQ(values_report("fast", {"%MW0"}, reading), "values of cycle fast: no scan is complete yet\n");
}

TEST(CycleReport, tells_a_fault_with_code_scan_and_step) {
  const Fault fault{FaultCode::watchdog, ScanAction::execute, 1234, 150'012us};
  EXPECT_EQ(to_string(fault),
            "watchdog (1): the scan was longer than its limit; after 150 ms of scan 1234, in execute");
  CycleStatus status;
  status.fault = fault;
  EXPECT_NE(cycle_report("a", 1ms, status, {}).find("fault: watchdog (1)"), std::string::npos);
}

}  // namespace
}  // namespace emulator_models
