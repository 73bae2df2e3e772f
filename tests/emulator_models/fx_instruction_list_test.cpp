// Instruction list on FX devices: addresses, refusals with the range of the model, timers and counters.
#include <gtest/gtest.h>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/latched_ranges.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"
#include "emulator_models/special_devices.hpp"
#include "tests/emulator_models/soft_plc/il_rig.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Model;
using soft_plc::program_of;

struct FxRig {
  FxRig(std::string_view variables, std::string_view body, Model model = Model::fx3u) : memory{model} {
    auto compiled = soft_plc::compile(program_of(variables, body), FxAddressMap{model});
    if (!compiled) {
      ADD_FAILURE() << to_string(compiled.error());
      return;
    }
    program = std::move(*compiled);
    machine.emplace(program);
  }

  void set(std::string_view device, std::uint32_t value) { memory.set(device_of(device), value); }
  std::uint32_t get(std::string_view device) const { return memory.get(device_of(device)); }
  /// Time passes, then a scan.
  void scan(std::chrono::nanoseconds step = 10ms) {
    now += step;
    const auto scanned = machine->run_scan({memory.inputs(), memory.outputs(), memory.bytes()}, now);
    EXPECT_TRUE(scanned.has_value());
  }

  DeviceMemory memory;
  soft_plc::IlProgram program;
  std::optional<soft_plc::IlMachine> machine;
  std::chrono::nanoseconds now{1h};

 private:
  protocol::fx::Device device_of(std::string_view name) const {
    return protocol::fx::parse_device(name, memory.model()).value();
  }
};

std::string refusal(std::string_view variables, std::string_view body = "LD TRUE",
                    Model model = Model::fx3u) {
  const auto compiled = soft_plc::compile(program_of(variables, body), FxAddressMap{model});
  return compiled ? "compiled" : to_string(compiled.error());
}

TEST(FxInstructionList, variables_lie_at_devices_and_x_and_y_count_in_octal) {
  FxRig rig{
      "start AT X17 : BOOL; motor AT Y20 : BOOL; flag AT M7679 : BOOL; state AT S4095 : BOOL; run AT M8000 "
      ": BOOL; speed AT D7999 : INT; copy AT D0 : INT; limit AT D8000 : INT;",
      "LD start\nST motor\nST flag\nS state\nLD speed\nST copy\nLD limit\nADD 1\nST limit"};
  rig.set("X17", 1);
  rig.set("D7999", 1234);
  rig.set("D8000", 200);
  rig.scan();
  EXPECT_EQ(rig.get("Y20"), 1U);
  EXPECT_EQ(rig.get("M7679"), 1U);
  EXPECT_EQ(rig.get("S4095"), 1U);
  EXPECT_EQ(rig.get("D0"), 1234U);
  EXPECT_EQ(rig.get("D8000"), 201U);
}

TEST(FxInstructionList, a_long_type_takes_as_many_registers_as_it_has_words_low_word_first) {
  FxRig rig{"long AT D10 : DINT;", "LD 16#12345678\nST long"};
  rig.scan();
  EXPECT_EQ(rig.get("D10"), 0x5678U);
  EXPECT_EQ(rig.get("D11"), 0x1234U);
  EXPECT_EQ(rig.get("D12"), 0U);
}

TEST(FxInstructionList, percent_addresses_reach_the_devices_of_their_number) {
  FxRig rig{
      "a AT %IX1.0 : BOOL; b AT %QX2.0 : BOOL; m120 AT %MX15.0 : BOOL; d100 AT %MW100 : INT; d8 AT %MD4 : "
      "DINT;",
      "LD a\nST b\nST m120\nST %MX1004.1\nLD 7\nST d100\nLD 65536\nST d8"};
  rig.set("X10", 1);
  rig.scan();
  EXPECT_EQ(rig.get("Y20"), 1U);
  EXPECT_EQ(rig.get("M120"), 1U);
  EXPECT_EQ(rig.get("M8033"), 1U);
  EXPECT_EQ(rig.get("D100"), 7U);
  EXPECT_EQ(rig.get("D8"), 0U);
  EXPECT_EQ(rig.get("D9"), 1U);
  EXPECT_EQ(rig.get("D7"), 0U);
  EXPECT_EQ(refusal("", "LD %MB3"),
            "2:4: %MB3: on an FX, %M has bits (%MX, the M) and words (%MW, the D), no bytes");
}

TEST(FxInstructionList, what_the_model_has_not_is_refused_with_its_place_and_the_range) {
  EXPECT_EQ(refusal("x AT X20 : BOOL;", "LD x", Model::fx1s), "1:20: X20 does not exist: FX1S has X0 to X17");
  EXPECT_EQ(refusal("x AT D256 : INT;", "LD x", Model::fx1s),
            "1:20: D256 does not exist: FX1S has D0 to D255 and D8000 to D8255");
  EXPECT_EQ(refusal("x AT X8 : BOOL;"), "1:20: X8: X and Y are numbered in octal: digits 0 to 7 only");
  EXPECT_EQ(refusal("x AT Q5 : BOOL;").substr(0, 5), "1:20:");
  EXPECT_EQ(
      refusal("x AT D7999 : DINT;"),
      "1:20: D7999 and the registers behind it that the type takes do not exist: FX3U has D0 to D7999 and "
      "D8000 to D8511");
  EXPECT_EQ(refusal("x AT D5 : BOOL;").substr(0, 5), "1:20:");
  EXPECT_EQ(refusal("x AT M5 : INT;").substr(0, 5), "1:20:");
  EXPECT_EQ(refusal("x AT T5 : BOOL;").substr(0, 5), "1:20:");
  EXPECT_EQ(refusal("", "CAL T64(IN := TRUE, PV := 5)", Model::fx1s),
            "2:5: T64 does not exist: FX1S has T0 to T63");
  EXPECT_NE(refusal("", "CAL C235(CU := TRUE)").find("high-speed"), std::string::npos);
  EXPECT_NE(refusal("T5 : TON;").find("there without a declaration"), std::string::npos);
}

TEST(FxInstructionList, a_program_cannot_write_inputs_and_what_the_plc_itself_writes) {
  EXPECT_NE(refusal("x AT X5 : BOOL;", "LD TRUE\nST x").find("a physical input"), std::string::npos);
  for (const char* const device : {"M8000", "M8002", "M8013"})
    EXPECT_NE(
        refusal("x AT " + std::string{device} + " : BOOL;", "LD TRUE\nST x").find("the PLC itself writes"),
        std::string::npos);
  EXPECT_NE(refusal("x AT D8009 : DINT;", "LD 1\nST x").find("the PLC itself writes"), std::string::npos);
  EXPECT_NE(refusal("", "LD TRUE\nST T5.Q").find("an output"), std::string::npos);
  EXPECT_EQ(refusal("x AT D8000 : INT; y AT M8034 : BOOL;", "LD 300\nST x\nLD TRUE\nST y"), "compiled");
}

TEST(FxInstructionList, devices_are_operands_without_a_declaration_bits_bool_and_registers_int) {
  FxRig rig{"",
            "LD X5\nANDN M100\nST Y12\nS s0\nLD D7999\nADD -5\nST D6\nLT 0\nST M7679\n"
            "LD M8000\nAND( X6\nOR X7\n)\nST M1"};
  rig.set("X5", 1);
  rig.set("X7", 1);
  rig.set("M8000", 1);
  rig.set("D7999", 3);
  rig.scan();
  EXPECT_EQ(rig.get("Y12"), 1U);
  EXPECT_EQ(rig.get("S0"), 1U);
  EXPECT_EQ(rig.get("D6"), 0xFFFEU);
  EXPECT_EQ(rig.get("M7679"), 1U);
  EXPECT_EQ(rig.get("M1"), 1U);
  rig.set("M100", 1);
  rig.scan();
  EXPECT_EQ(rig.get("Y12"), 0U);
}

TEST(FxInstructionList, undeclared_devices_are_parameters_of_blocks_and_functions) {
  FxRig rig{"t : TON;", "CAL t(IN := X0, PT := T#20ms, Q => Y0)\nLD D0\nLIMIT D1, D2\nST D3"};
  rig.set("X0", 1);
  rig.set("D0", 1);
  rig.set("D1", 7);
  rig.set("D2", 5);
  for (int i = 0; i < 3; ++i) rig.scan();
  EXPECT_EQ(rig.get("Y0"), 1U);
  EXPECT_EQ(rig.get("D3"), 5U);
}

TEST(FxInstructionList, an_undeclared_device_is_refused_at_its_place_as_a_declared_one_is) {
  EXPECT_EQ(refusal("", "LD X20", Model::fx1s), "2:4: X20 does not exist: FX1S has X0 to X17");
  EXPECT_EQ(refusal("", "LD TRUE\nAND M99999"),
            "3:5: M99999 does not exist: FX3U has M0 to M7679 and M8000 to M8511");
  EXPECT_EQ(refusal("", "LD Y8"), "2:4: Y8: X and Y are numbered in octal: digits 0 to 7 only");
  EXPECT_EQ(refusal("", "LD TRUE\nST X5"),
            "3:1: X5 is a physical input and cannot be written by the program");
  for (const char* const write : {"ST M8002", "S M8013", "R X0"})
    EXPECT_NE(refusal("", "LD TRUE\n" + std::string{write}).find("cannot be written"), std::string::npos);
  EXPECT_NE(refusal("", "LD 1\nST D8010").find("the PLC itself writes"), std::string::npos);
  EXPECT_EQ(refusal("", "LD D5\nAND 1").substr(0, 4), "3:1:");
  EXPECT_NE(refusal("", "LD T5").find("name one of its values"), std::string::npos);
  EXPECT_NE(refusal("", "LD D").find("not declared"), std::string::npos);
  EXPECT_NE(refusal("", "LD X5.Q").find("no function block"), std::string::npos);
  EXPECT_NE(refusal("", "CAL X5").find("no instance"), std::string::npos);
}

TEST(FxInstructionList, labels_and_declared_names_hide_devices) {
  FxRig rig{"m1 : BOOL;", "LD X0\nJMPC M9999\nLD TRUE\nST m1\nLD m1\nST Y0\nM9999:\nLD TRUE\nST Y1"};
  rig.scan();
  EXPECT_EQ(rig.get("M1"), 0U);
  EXPECT_EQ(rig.get("Y0"), 1U);
  EXPECT_EQ(rig.get("Y1"), 1U);
}

TEST(FxInstructionList, the_soft_plc_without_fx_knows_no_devices) {
  EXPECT_EQ(soft_plc::refusal_of("", "LD X5").place, "2:4");
  EXPECT_EQ(soft_plc::refusal_of("x AT X5 : BOOL;", "LD x").place, "1:20");
  EXPECT_EQ(soft_plc::refusal_of("", "CAL T5").place, "2:5");
}

/// IN is M0; PV 3 units. @return "value contact" after each scan of `step`
std::string timer_trace(const std::string& timer, std::chrono::milliseconds step, int scans) {
  FxRig rig{"on AT M0 : BOOL;", "CAL " + timer + "(IN := on, PV := 3)"};
  rig.set("M0", 1);
  std::string trace;
  for (int i = 0; i < scans; ++i) {
    rig.scan(step);
    trace += std::to_string(rig.get("TN" + timer.substr(1))) + (rig.get("TS" + timer.substr(1)) ? "* " : " ");
  }
  return trace;
}

TEST(FxTimer, counts_in_the_unit_of_its_number_and_never_rounds_up) {
  EXPECT_EQ(timer_trace("T0", 50ms, 9), "0 0 1 1 2 2 3* 3* 3* ");
  EXPECT_EQ(timer_trace("T199", 100ms, 4), "0 1 2 3* ");
  EXPECT_EQ(timer_trace("T200", 10ms, 4), "0 1 2 3* ");
  EXPECT_EQ(timer_trace("T245", 4ms, 9), "0 0 0 1 1 2 2 2 3* ");
  EXPECT_EQ(timer_trace("T246", 1ms, 4), "0 1 2 3* ");
  EXPECT_EQ(timer_trace("T249", 1ms, 4), "0 1 2 3* ");
  EXPECT_EQ(timer_trace("T250", 100ms, 4), "0 1 2 3* ");
  EXPECT_EQ(timer_trace("T255", 250ms, 3), "0 2 3* ");
}

TEST(FxTimer, contact_and_current_value_are_the_devices_that_the_port_reads_and_writes) {
  FxRig rig{"on AT M0 : BOOL; lamp AT Y0 : BOOL; v AT D0 : INT;",
            "CAL T200(IN := on, PV := 50)\nLD T200.Q\nST lamp\nLD T200.CV\nST v"};
  rig.set("M0", 1);
  rig.scan();
  rig.scan();
  EXPECT_EQ(rig.get("TN200"), 1U);
  EXPECT_EQ(rig.get("D0"), 1U);
  rig.set("TN200", 48);  // by the port
  rig.scan();
  EXPECT_EQ(rig.get("Y0"), 0U);
  rig.scan();
  EXPECT_EQ(rig.get("TS200"), 1U);
  EXPECT_EQ(rig.get("Y0"), 1U);
  rig.set("M0", 0);
  rig.scan();
  EXPECT_EQ(rig.get("TN200"), 0U);
  EXPECT_EQ(rig.get("TS200"), 0U);
}

TEST(FxTimer, a_retentive_one_keeps_its_value_until_its_reset) {
  FxRig rig{"on AT M0 : BOOL; clear AT M1 : BOOL;", "CAL T246(IN := on, R := clear, PV := 30)"};
  rig.set("M0", 1);
  rig.scan();
  rig.scan();
  rig.set("M0", 0);
  rig.scan();
  EXPECT_EQ(rig.get("TN246"), 10U);
  rig.set("M0", 1);
  for (int i = 0; i < 3; ++i) rig.scan();
  EXPECT_EQ(rig.get("TN246"), 30U);
  EXPECT_EQ(rig.get("TS246"), 1U);
  rig.set("M1", 1);
  rig.scan();
  EXPECT_EQ(rig.get("TN246"), 0U);
  EXPECT_EQ(rig.get("TS246"), 0U);
}

void pulse(FxRig& rig, int count) {
  for (int i = 0; i < count; ++i) {
    rig.set("M0", 1);
    rig.scan();
    rig.scan();
    rig.set("M0", 0);
    rig.scan();
  }
}

TEST(FxCounter, counts_rising_edges_up_to_its_preset_and_stays_there) {
  FxRig rig{"in AT M0 : BOOL; clear AT M1 : BOOL;", "CAL C5(CU := in, R := clear, PV := 3)"};
  pulse(rig, 2);
  EXPECT_EQ(rig.get("CN5"), 2U);
  EXPECT_EQ(rig.get("CS5"), 0U);
  pulse(rig, 3);
  EXPECT_EQ(rig.get("CN5"), 3U);
  EXPECT_EQ(rig.get("CS5"), 1U);
  rig.set("M1", 1);
  rig.scan();
  EXPECT_EQ(rig.get("CN5"), 0U);
  EXPECT_EQ(rig.get("CS5"), 0U);
}

TEST(FxCounter, from_c200_on_it_has_32_bits_and_counts_down_while_its_relay_is_on) {
  FxRig rig{"in AT M0 : BOOL;", "CAL C201(CU := in, PV := 70000)"};
  rig.set("CN201", 69'999);
  pulse(rig, 2);
  EXPECT_EQ(rig.get("CN201"), 70'001U);
  EXPECT_EQ(rig.get("CS201"), 1U);
  rig.set("M8201", 1);
  pulse(rig, 2);
  EXPECT_EQ(rig.get("CN201"), 69'999U);
  EXPECT_EQ(rig.get("CS201"), 0U);
  rig.set("CN201", 0);
  pulse(rig, 1);
  EXPECT_EQ(rig.get("CN201"), 0xFFFF'FFFFU);
}

TEST(LatchedRanges, of_each_family_are_kept_and_their_neighbours_cleared) {
  const struct {
    Model model;
    std::vector<std::string> kept, cleared;
  } families[] = {
      {Model::fx1s, {"M384", "S0", "CN16", "D128"}, {"M383", "CN15", "D127", "D200", "TN63", "Y0"}},
      {Model::fx1n, {"M384", "S0", "CN16", "D128", "TN246", "CN220"}, {"M383", "CN15", "D127", "CN219"}},
      {Model::fx2n, {"M500", "S500", "CN100", "D218", "TS255"}, {"M499", "S499", "CN99", "D199", "D217"}},
      {Model::fx3u, {"M7679", "S500", "CN220", "D218", "TN246"}, {"M499", "D200", "TN256", "TN245", "CS99"}}};
  for (const auto& family : families) {
    DeviceMemory memory{family.model};
    const auto device = [&](const std::string& name) {
      return protocol::fx::parse_device(name, family.model).value();
    };
    for (const auto& names : {family.kept, family.cleared})
      for (const std::string& name : names) memory.set(device(name), 1);
    memory.set(device("M8034"), 1);
    clear_unlatched(memory);
    for (const std::string& name : family.kept) EXPECT_EQ(memory.get(device(name)), 1U) << name;
    for (const std::string& name : family.cleared) EXPECT_EQ(memory.get(device(name)), 0U) << name;
    EXPECT_EQ(memory.get(device("M8034")), 1U);
    clear_all_but_special(memory);
    for (const std::string& name : family.kept) EXPECT_EQ(memory.get(device(name)), 0U) << name;
  }
}

}  // namespace
}  // namespace emulator_models
