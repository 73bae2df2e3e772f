// The machine: faults with their place, the budget, start, images.
#include "emulator_models/soft_plc/il_machine.hpp"

#include <sstream>
#include <utility>

#include <gtest/gtest.h>

#include "tests/emulator_models/soft_plc/il_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

TEST(IlMachine, division_by_zero_stops_the_scan_at_its_place) {
  IlRig rig{"i, j, k : INT; x, y : REAL;", "LD 1\nST k\nLD i\n  DIV j\nST k"};
  EXPECT_EQ(rig.scan(), "5:3: division by zero");
  EXPECT_EQ(rig.get("k"), "1");
  EXPECT_EQ((IlRig{"i, j : INT;", "LD i\nMOD j"}.scan()), "3:1: division by zero");
  EXPECT_EQ((IlRig{"x, y : REAL;", "LD x\nDIV y"}.scan()), "3:1: division by zero");
  EXPECT_EQ((IlRig{"i, j : INT;", "LD i\nDIV( j\nADD 0\n)"}.scan()), "3:1: division by zero");
}

TEST(IlMachine, a_fault_does_not_outlast_its_scan) {
  IlRig rig{"i, j, k : INT;", "LD 6\nDIV j\nST k"};
  EXPECT_NE(rig.scan(), "ok");
  EXPECT_EQ(rig.run("j=2 -> k=3"), "");
}

TEST(IlMachine, an_endless_loop_is_stopped_at_its_jump) {
  IlRig rig{"i : INT;", "here: LD i\nADD 1\nST i\nJMP here"};
  EXPECT_EQ(rig.scan(400), "5:1: more instructions in one scan than allowed");
  EXPECT_EQ(rig.get("i"), "101");
  IlRig empty{"i : INT;", "here:\nJMP here"};
  EXPECT_EQ(empty.scan(), "3:1: more instructions in one scan than allowed");
}

TEST(IlMachine, a_scan_may_use_its_whole_budget_and_not_one_instruction_more) {
  IlRig rig{"a, q : BOOL;", "LD a\nST q"};  // and the end
  EXPECT_EQ(rig.scan(3), "ok");
  EXPECT_EQ(rig.scan(2), "3:1: more instructions in one scan than allowed");
}

/// Slices until the scan ends or faults. @return their number, and the fault
std::pair<int, std::string> run_in_slices(IlMachine& machine, std::uint64_t length,
                                          std::uint64_t budget = IlMachine::default_budget) {
  for (int slices = 1;; ++slices) {
    // Time goes on between slices; the scan must not see it.
    const auto end = machine.run_slice({}, std::chrono::milliseconds{slices}, length, budget);
    if (!end) return {slices, to_string(end.error())};
    if (*end == SliceEnd::scan) return {slices, ""};
  }
}

TEST(IlMachine, a_scan_in_slices_does_what_a_scan_at_once_does_and_sees_one_time) {
  const char* const body =
      "LD 0\nST i\nagain: LD i\nADD 1\nST i\nLD TRUE\nAND( a\nSEL b, c\nAND d\n)\nST q\n"
      "CAL t(IN := TRUE, PT := T#1ms)\nLD i\nLT 10\nJMPC again";
  const char* const variables = "i : INT; a : BOOL; b, d : BOOL := TRUE; c, q : BOOL; t : TON;";
  IlRig at_once{variables, body};
  EXPECT_EQ(at_once.scan(), "ok");
  for (const std::uint64_t length : {1U, 7U, 50U}) {
    IlRig sliced{variables, body};
    const auto [slices, fault] = run_in_slices(sliced.machine(), length);
    EXPECT_EQ(fault, "");
    EXPECT_GE(slices, 200 / static_cast<int>(length + 20));
    for (const char* const name : {"i", "q"}) EXPECT_EQ(sliced.get(name), at_once.get(name)) << name;
    EXPECT_EQ(sliced.get("i"), "10");
    EXPECT_EQ(sliced.get("q"), "1");
  }
}

TEST(IlMachine, an_endless_loop_in_slices_goes_on_until_the_budget_of_the_scan_is_spent) {
  IlRig rig{"i : INT;", "here: LD i\nADD 1\nST i\nJMP here"};
  const auto [slices, fault] = run_in_slices(rig.machine(), 40, 400);
  EXPECT_EQ(fault, "5:1: more instructions in one scan than allowed");
  EXPECT_GE(slices, 9);
  EXPECT_EQ(rig.get("i"), "101");
}

TEST(IlMachine, an_abandoned_scan_begins_again_at_the_first_instruction) {
  IlRig rig{"i, j : INT;", "LD j\nADD 1\nST j\nhere: LD i\nADD 1\nST i\nLT 100\nJMPC here"};
  const auto slice = [&] { return rig.machine().run_slice({}, {}, 10); };
  EXPECT_EQ(slice(), SliceEnd::length);
  EXPECT_EQ(slice(), SliceEnd::length);
  EXPECT_EQ(rig.get("j"), "1");
  rig.machine().abandon_scan();
  EXPECT_EQ(slice(), SliceEnd::length);
  EXPECT_EQ(rig.get("j"), "2");
}

TEST(IlMachine, conversions_out_of_range_and_negative_shifts_are_faults) {
  IlRig conversion{"x : REAL; i : INT;", "LD x\nREAL_TO_INT\nST i"};
  EXPECT_EQ(conversion.run("x=32767.4 -> i=32767 ; x=-32768.5 -> i=-32768"), "");
  conversion.set("x", "32767.6");
  EXPECT_EQ(conversion.scan(), "3:1: the number does not fit the type it is converted to");
  conversion.set("x", "nan");
  EXPECT_NE(conversion.scan(), "ok");
  IlRig shift{"w : WORD; n : INT;", "LD w\nSHL n"};
  shift.set("n", "-1");
  EXPECT_EQ(shift.scan(), "3:1: shift by a negative number of bits");
}

TEST(IlMachine, a_cold_start_sets_initial_values_and_a_warm_one_keeps_what_is_retained) {
  IlRig rig{"a : INT := 5; END_VAR VAR RETAIN b : INT := 7; t : CTU;",
            "LD a\nADD 1\nST a\nLD b\nADD 1\nST b\nLD TRUE\nCU t"};
  EXPECT_EQ(rig.run("-> a=6 b=8"), "");
  rig.machine().start(IlMachine::Start::warm);
  EXPECT_EQ(rig.get("a"), "5");
  EXPECT_EQ(rig.get("b"), "8");
  rig.machine().start(IlMachine::Start::cold);
  EXPECT_EQ(rig.get("a"), "5");
  EXPECT_EQ(rig.get("b"), "7");
}

TEST(IlMachine, initial_values_of_outputs_are_written_in_the_first_scan_after_a_cold_start) {
  IlRig rig{"lamp AT %QX0.0 : BOOL := TRUE; w AT %MW1 : INT := -2; a : BOOL;", "LD a"};
  EXPECT_EQ(rig.run("-> Q0=1 M2=254 M3=255 ; Q0=0 -> Q0=0"), "");
  rig.machine().start(IlMachine::Start::warm);
  EXPECT_EQ(rig.run("-> Q0=0"), "");
  rig.machine().start(IlMachine::Start::cold);
  EXPECT_EQ(rig.run("-> Q0=1"), "");
}

TEST(IlMachine, an_image_that_ends_before_an_address_in_use_is_a_fault_and_nothing_runs) {
  const auto program = compile(program_of("q : BOOL;", "LD TRUE\nST q\nLD %IW1\nST %QW1"));
  ASSERT_TRUE(program.has_value());
  IlMachine machine{*program};
  std::array<std::byte, 4> inputs{};
  std::array<std::byte, 4> outputs{};
  const auto scan = [&](std::size_t input_bytes, std::size_t output_bytes) {
    return machine
        .run_scan({std::span{inputs}.first(input_bytes), std::span{outputs}.first(output_bytes), {}},
                  std::chrono::nanoseconds{0})
        .has_value();
  };
  EXPECT_FALSE(scan(3, 4));
  EXPECT_FALSE(scan(4, 3));
  EXPECT_EQ(machine.value("Q"), 0U);
}

TEST(IlMachine, values_are_read_and_set_by_name_and_those_at_addresses_are_not) {
  IlRig rig{"a : INT; x AT %MW0 : INT;", "LD a"};
  EXPECT_TRUE(rig.machine().set_value("A", 0x1'0005));
  EXPECT_EQ(rig.machine().value("A"), 5U);
  EXPECT_FALSE(rig.machine().value("X").has_value());
  EXPECT_FALSE(rig.machine().set_value("B", 1));
}

TEST(IlMachine, a_program_has_a_longest_length) {
  std::string body{"LD a"};
  for (std::size_t i = 0; i + 2 < code_length_max; ++i) body.append("\nAND a");
  EXPECT_EQ(refusal_of("a : BOOL;", body).place, "compiled");
  EXPECT_EQ(refusal_of("a : BOOL;", body + "\nAND a").place, std::to_string(code_length_max + 1) + ":1");
}

TEST(IlMachine, labels_that_wait_for_one_another_do_not_keep_the_compiler_busy) {
  std::ostringstream body;
  body << "LD a\nJMP l2000\nl0: RET\n";
  for (int i = 1; i < 2000; ++i) body << 'l' << i << ": JMP l" << i - 1 << '\n';
  body << "l2000: JMP l1999";
  EXPECT_EQ(refusal_of("a : BOOL;", body.str()).place, "compiled");
}

}  // namespace
}  // namespace emulator_models::soft_plc
