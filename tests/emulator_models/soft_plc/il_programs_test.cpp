// Small programs with results worked out by hand, and programs that must be refused, with the place.
//
// A step is "inputs -> outputs", a scan each, 10 ms apart; TIME in milliseconds.
#include <array>
#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "tests/emulator_models/soft_plc/il_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

struct GoodProgram {
  const char* name;
  const char* variables;
  const char* body;
  const char* steps;
};

void PrintTo(const GoodProgram& program, std::ostream* out) { *out << program.name; }

constexpr const char* abcq = "a, b, c, q : BOOL;";
constexpr const char* ints = "i, j, k : INT; q : BOOL;";

const GoodProgram good_programs[] = {
    // Boolean rungs.
    {"series", abcq, "LD a\nAND b\nST q", "a=1 b=0 -> q=0 ; b=1 -> q=1 ; a=0 -> q=0"},
    {"parallel", abcq, "LD a\nOR b\nST q", "-> q=0 ; b=1 -> q=1 ; a=1 b=0 -> q=1"},
    {"exclusive", abcq, "LD a\nXOR b\nST q", "-> q=0 ; a=1 -> q=1 ; b=1 -> q=0"},
    {"series_with_break_contact", abcq, "LD a\nANDN b\nST q", "a=1 -> q=1 ; b=1 -> q=0"},
    {"parallel_with_break_contact", abcq, "LD a\nORN b\nST q", "-> q=1 ; b=1 -> q=0 ; a=1 -> q=1"},
    {"equivalence", abcq, "LD a\nXORN b\nST q", "-> q=1 ; a=1 -> q=0 ; b=1 -> q=1"},
    {"ampersand_is_and", abcq, "LD a\n& b\nST q", "a=1 -> q=0 ; b=1 -> q=1"},
    {"ampersand_n_is_andn", abcq, "LD a\n&N b\nST q", "a=1 -> q=1 ; b=1 -> q=0"},
    {"load_negated", abcq, "LDN a\nST q", "-> q=1 ; a=1 -> q=0"},
    {"store_negated", abcq, "LD a\nSTN q\nST c", "-> q=1 c=0 ; a=1 -> q=0 c=1"},
    {"invert", abcq, "LD a\nOR b\nNOT\nST q", "-> q=1 ; b=1 -> q=0"},
    {"latch_reset_wins", abcq, "LD a\nS q\nLD b\nR q", "a=1 -> q=1 ; a=0 -> q=1 ; a=1 b=1 -> q=0"},
    {"self_holding", "start, stop, motor : BOOL;", "LD start\nOR motor\nANDN stop\nST motor",
     "start=1 -> motor=1 ; start=0 -> motor=1 ; stop=1 -> motor=0 ; stop=0 -> motor=0"},
    {"two_stores_of_one_result", abcq, "LD a\nST q\nST c", "a=1 -> q=1 c=1"},
    {"names_in_any_case", abcq, "ld A\nAnd B\nsT Q", "a=1 b=1 -> q=1"},
    {"comments_everywhere", abcq, "(* rung *) LD (* in *) a\n\n(* over\nlines *)\nST q (* out *)",
     "a=1 -> q=1"},

    // Parentheses.
    {"parenthesis_long_form", abcq, "LD a\nAND(\nLD b\nOR c\n)\nST q",
     "a=1 -> q=0 ; c=1 -> q=1 ; a=0 -> q=0"},
    {"parenthesis_short_form", abcq, "LD a\nAND( b\nOR c\n)\nST q", "a=1 c=1 -> q=1 ; c=0 -> q=0"},
    {"parenthesis_negated_as_a_whole", abcq, "LD a\nANDN( b\nOR c\n)\nST q", "a=1 -> q=1 ; b=1 -> q=0"},
    {"or_negated_parenthesis", abcq, "LD a\nORN( b\nAND c\n)\nST q", "-> q=1 ; b=1 c=1 -> q=0"},
    {"xor_negated_parenthesis", abcq, "LD a\nXORN( b\nAND c\n)\nST q",
     "-> q=1 ; a=1 -> q=0 ; b=1 c=1 -> q=1"},
    {"parenthesis_in_parenthesis", "a, b, c, d, q : BOOL;", "LD a\nAND( b\nOR( c\nAND d\n)\n)\nST q",
     "a=1 c=1 -> q=0 ; d=1 -> q=1 ; a=0 -> q=0"},
    {"subtraction_keeps_its_order", ints, "LD i\nSUB( j\nADD k\n)\nST i", "i=10 j=3 k=2 -> i=5"},
    {"division_keeps_its_order", ints, "LD i\nDIV( j\nSUB k\n)\nST i", "i=100 j=12 k=2 -> i=10"},
    {"compare_with_a_parenthesis", ints, "LD i\nGT( j\nADD k\n)\nST q", "i=6 j=3 k=2 -> q=1 ; i=5 -> q=0"},
    {"bool_less_than_a_parenthesis", abcq, "LD a\nLT( b\nAND c\n)\nST q", "b=1 c=1 -> q=1 ; a=1 -> q=0"},
    {"literal_before_a_parenthesis", ints, "LD 2\nMUL( i\nADD 1\n)\nST j", "i=3 -> j=8"},
    {"parenthesis_of_literals", ints, "LD 2\nMUL( 3\nADD 4\n)\nST i", "-> i=14"},

    // Numbers.
    {"sum", ints, "LD i\nADD j\nST k", "i=40 j=2 -> k=42 ; j=-50 -> k=-10"},
    {"literals_take_the_type_of_the_target", "l : LINT; u : USINT;", "LD 5\nADD 3\nST l\nLD 255\nST u",
     "-> l=8 u=255"},
    {"division_cuts_off", ints, "LD i\nDIV 2\nST j\nLD i\nMOD 2\nST k", "i=7 -> j=3 k=1 ; i=-7 -> j=-3 k=-1"},
    {"int_wraps", ints, "LD i\nADD 1\nST i", "i=32767 -> i=-32768"},
    {"what_wrapped_is_what_is_compared", ints, "LD i\nADD 1\nLT 0\nST q", "i=32767 -> q=1 ; i=5 -> q=0"},
    {"sint_wraps", "n : SINT;", "LD n\nSUB 1\nST n", "n=-128 -> n=127"},
    {"usint_wraps", "u : USINT;", "LD u\nMUL 2\nST u", "u=200 -> u=144"},
    {"udint_wraps", "u : UDINT;", "LD u\nADD 1\nST u", "u=4294967295 -> u=0"},
    {"ulint_divides_unsigned", "u : ULINT;", "LD u\nDIV 2\nST u",
     "u=18446744073709551614 -> u=9223372036854775807"},
    {"least_int_by_minus_one_wraps", ints, "LD i\nDIV j\nST k", "i=-32768 j=-1 -> k=-32768"},
    {"least_lint_by_minus_one_wraps", "l, m : LINT;", "LD l\nDIV m\nST l",
     "l=-9223372036854775808 m=-1 -> "
     "l=-9223372036854775808"},
    {"real_arithmetic", "x : REAL;", "LD x\nMUL 2.0\nSUB 0.5\nDIV 4.0\nST x", "x=1.25 -> x=0.5"},
    {"lreal_arithmetic", "x : LREAL;", "LD x\nADD 1.0E3\nST x", "x=0.25 -> x=1000.25"},
    {"comparisons", "i : INT; g, g2, e, n, l2, l : BOOL;",
     "LD i\nGT 5\nST g\nLD i\nGE 5\nST g2\nLD i\nEQ 5\nST e\nLD i\nNE 5\nST n\nLD i\nLE 5\nST l2\nLD i\nLT "
     "5\nST l",
     "i=5 -> g=0 g2=1 e=1 n=0 l2=1 l=0 ; i=6 -> g=1 g2=1 e=0 n=1 l2=0 l=0 ; i=-1 -> g=0 g2=0 e=0 n=1 l2=1 "
     "l=1"},
    {"bool_comparisons", "a, b, g, g2, e, n, l2, l : BOOL;",
     "LD a\nGT b\nST g\nLD a\nGE b\nST g2\nLD a\nEQ b\nST e\nLD a\nNE b\nST n\nLD a\nLE b\nST l2\nLD a\nLT "
     "b\n"
     "ST l",
     "-> g=0 g2=1 e=1 n=0 l2=1 l=0 ; a=1 -> g=1 g2=1 e=0 n=1 l2=0 l=0 ; a=0 b=1 -> g=0 g2=0 e=0 n=1 l2=1 "
     "l=1"},
    {"time_sum_and_difference", "t, u : TIME;", "LD t\nADD T#1s\nSUB T#200ms\nST u", "t=50 -> u=850"},
    {"time_compare", "t : TIME; q : BOOL;", "LD t\nGE T#1.5s\nST q", "t=1499 -> q=0 ; t=1500 -> q=1"},

    // Bit strings.
    {"mask", "w : WORD;", "LD w\nAND 16#0FF0\nST w", "w=4660 -> w=560"},
    {"mask_negated", "w, m : WORD;", "LD w\nANDN m\nST w", "w=65535 m=255 -> w=65280"},
    {"complement", "b : BYTE;", "LD b\nNOT\nST b", "b=5 -> b=250"},
    {"load_and_store_negated_words", "w, v : WORD;", "LDN w\nST v\nSTN w", "w=1 -> v=65534 w=1"},
    {"word_parenthesis_negated", "w, v : WORD;", "LD w\nANDN( v\nOR 16#F000\n)\nST w",
     "w=65535 v=15 -> w=4080"},
    {"shift", "w : WORD;", "LD w\nSHL 4\nST w", "w=4660 -> w=9024"},
    {"shift_right", "b : BYTE;", "LD b\nSHR 3\nST b", "b=200 -> b=25"},
    {"rotate", "b, c : BYTE;", "LD b\nROL 1\nST c\nROR 2\nST b", "b=129 -> c=3 b=192"},
    {"shift_of_lword_by_its_width", "l : LWORD; n : INT;", "LD l\nSHR n\nST l",
     "l=255 n=63 -> l=0 ; l=255 n=64 -> l=0"},
    {"rotation_by_the_width_changes_nothing", "l : LWORD; b : BYTE; n : INT;",
     "LD l\nROL n\nST l\nLD b\nROR n\nST b", "l=255 b=9 n=64 -> l=255 b=9 ; n=0 -> l=255 b=9"},
    {"shift_by_the_width_gives_zero", "w : WORD; n : INT;", "LD w\nSHL n\nST w", "w=65535 n=16 -> w=0"},

    // Jumps.
    {"jump_over", ints, "LD i\nJMP past\nLD INT#9\npast: ST j", "i=3 -> j=3"},
    {"conditional_jump", ints, "LD q\nJMPC yes\nLD 1\nST i\nRET\nyes: LD 2\nST i", "q=1 -> i=2 ; q=0 -> i=1"},
    {"negated_conditional_jump", ints, "LD q\nJMPCN no\nLD 1\nST i\nRET\nno:\nLD 2\nST i",
     "q=1 -> i=1 ; q=0 -> i=2"},
    {"loop", ints, "LD 0\nST i\nST j\nagain:\nLD i\nADD j\nST i\nLD j\nADD 1\nST j\nLE 4\nJMPC again",
     "-> i=10 j=5"},
    {"return_early", ints, "LD q\nRETC\nLD 7\nST i", "q=1 -> i=0 ; q=0 -> i=7"},
    {"return_if_not", ints, "LD q\nRETCN\nLD 7\nST i", "q=0 -> i=0 ; q=1 -> i=7"},
    {"case_of_three", ints,
     "LD i\nEQ 1\nJMPC one\nLD i\nEQ 2\nJMPC two\nLD 0\nST j\nRET\none:\nLD 10\nST j\nRET\ntwo: LD "
     "20\nST j",
     "i=1 -> j=10 ; i=2 -> j=20"},

    // Functions.
    {"absolute", ints, "LD i\nABS\nST j", "i=-5 -> j=5 ; i=5 -> j=5"},
    {"least_and_greatest", ints, "LD i\nMAX j, k\nST k", "i=1 j=7 k=3 -> k=7"},
    {"limit", ints, "LD 0\nLIMIT i, 100\nST j", "i=-3 -> j=0 ; i=50 -> j=50 ; i=101 -> j=100"},
    {"limit_in_formal_form", ints, "LIMIT(\nMN := 0,\nIN := i,\nMX := 100\n)\nST j",
     "i=500 -> j=100 ; i=-1 -> j=0"},
    {"formal_parameters_in_any_order", ints, "LIMIT(MX := 100, MN := 0, IN := i)\nST j", "i=500 -> j=100"},
    {"select", ints, "LD q\nSEL i, j\nST k", "q=0 i=4 j=5 -> k=4 ; q=1 -> k=5"},
    {"select_between_literals_and_variables", ints, "LD q\nSEL 0, j\nST k", "j=5 -> k=0 ; q=1 -> k=5"},
    {"int_to_real_and_back", "i : INT; x : REAL;", "LD i\nINT_TO_REAL\nMUL 1.5\nST x\nREAL_TO_INT\nST i",
     "i=3 -> x=4.5 i=4 ; i=5 -> x=7.5 i=8"},
    {"narrowing_takes_the_low_bits", "d : DINT; i : INT;", "LD d\nDINT_TO_INT\nST i", "d=65537 -> i=1"},
    {"word_to_int_keeps_the_bits", "w : WORD; i : INT;", "LD w\nWORD_TO_INT\nST i", "w=65535 -> i=-1"},
    {"time_to_milliseconds", "t : TIME; d : DINT;", "LD t\nTIME_TO_DINT\nST d\nADD 5\nDINT_TO_TIME\nST t",
     "t=1500 -> d=1500 t=1505"},
    {"bool_to_int", ints, "LD q\nBOOL_TO_INT\nADD i\nST i", "q=1 i=4 -> i=5"},

    // Direct addresses.
    {"input_to_output", "x : BOOL;", "LD %IX0.3\nST %QX1.7", "I0=8 -> Q1=128 ; I0=247 Q1=255 -> Q1=127"},
    {"bit_without_its_x", "x : BOOL;", "LD %I0.0\nAND %I0.1\nST %Q0.0", "I0=3 -> Q0=1 ; I0=1 -> Q0=0"},
    {"set_and_reset_a_bit_of_a_byte", "x : BOOL;", "LD %IX0.0\nS %QX0.4\nR %QX0.1", "I0=1 Q0=3 -> Q0=17"},
    {"words_and_bits_share_memory", "x : BOOL;", "LD %MW1\nST %MW0\nLD TRUE\nST %MX2.0",
     "M2=52 M3=18 -> M0=52 M1=18 M2=53"},
    {"located_variables", "x AT %IB2 : USINT; y AT %QW1 : INT; n : INT;", "LD x\nUSINT_TO_INT\nMUL -1\nST y",
     "I2=2 -> Q2=254 Q3=255"},
    {"initial_value_of_an_output", "lamp AT %QX0.2 : BOOL := TRUE; a : BOOL;", "LD a\nR lamp",
     "-> Q0=4 ; a=1 -> Q0=0"},

    // Function blocks; a scan each 10 ms.
    {"on_delay", "t : TON; a, q : BOOL;", "CAL t(IN := a, PT := T#20ms, Q => q)",
     "a=1 -> q=0 ; -> q=0 ; -> q=1 ; a=0 -> q=0"},
    {"off_delay_by_inputs_stored_first", "t : TOF; a, q : BOOL;",
     "LD T#20ms\nST t.PT\nLD a\nST t.IN\nCAL t\nLD t.Q\nST q", "a=1 -> q=1 ; a=0 -> q=1 ; -> q=1 ; -> q=0"},
    {"pulse_by_position", "t : TP; a, q : BOOL; e : TIME;", "CAL t(a, T#20ms)\nLD t.Q\nST q\nLD t.ET\nST e",
     "a=1 -> q=1 e=0 ; a=0 -> q=1 e=10 ; -> q=0 e=0"},
    {"count_up", "c : CTU; a, q : BOOL; n : INT;", "CAL c(\nCU := a,\nPV := 2,\nQ => q,\nCV => n\n)",
     "a=1 -> n=1 q=0 ; a=0 -> n=1 ; a=1 -> n=2 q=1"},
    {"load_is_no_operator_of_a_down_counter", "c : CTD; a, l, q : BOOL; n : INT;",
     "LD 3\nST c.PV\nLD l\nST c.LD\nLD a\nCD c\nLD c.Q\nST q\nLD c.CV\nST n",
     "l=1 -> n=3 q=0 ; l=0 a=1 -> n=2 q=0 ; a=0 -> n=2 ; a=1 -> n=1 ; a=0 -> ; a=1 -> n=0 q=1"},
    {"edge_by_its_input_operator", "e : R_TRIG; a, q : BOOL;", "LD a\nCLK e\nLD e.Q\nST q",
     "-> q=0 ; a=1 -> q=1 ; -> q=0"},
    {"falling_edge_fires_at_first", "e : F_TRIG; a, q : BOOL;", "LD a\nCLK e\nLD e.Q\nST q",
     "-> q=1 ; -> q=0 ; a=1 -> q=0 ; a=0 -> q=1"},
    {"set_dominant_bistable", "f : SR; a, b, q : BOOL;", "LD a\nS1 f\nLD b\nR f\nLD f.Q1\nST q",
     "a=1 -> q=1 ; a=0 -> q=1 ; b=1 -> q=0 ; a=1 -> q=1"},
    {"reset_dominant_bistable", "f : RS; a, b, q : BOOL;", "LD a\nS f\nLD b\nR1 f\nLD f.Q1\nST q",
     "a=1 -> q=1 ; a=0 -> q=1 ; a=1 b=1 -> q=0"},
    {"timer_by_its_input_operators", "t : TON; a, q : BOOL;", "LD T#10ms\nPT t\nLD a\nIN t\nLD t.Q\nST q",
     "a=1 -> q=0 ; -> q=1"},
    {"conditional_call", "c : CTU; a, b : BOOL; n : INT;", "LD b\nCALC c(CU := a, PV := 5)\nLD c.CV\nST n",
     "a=1 -> n=0 ; b=1 -> n=1 ; a=0 b=0 -> n=1"},
};

class GoodPrograms : public testing::TestWithParam<GoodProgram> {};

TEST_P(GoodPrograms, give_the_results_worked_out_by_hand) {
  IlRig rig{GetParam().variables, GetParam().body};
  EXPECT_EQ(rig.run(GetParam().steps), "");
}

INSTANTIATE_TEST_SUITE_P(Il, GoodPrograms, testing::ValuesIn(good_programs),
                         [](const auto& given) { return std::string{given.param.name}; });

struct BadProgram {
  const char* name;
  const char* variables;
  const char* body;  ///< begins at line 2
  const char* place;
  const char* says;
};

void PrintTo(const BadProgram& program, std::ostream* out) { *out << program.name; }

const BadProgram bad_programs[] = {
    {"unknown_variable", abcq, "LD a\nAND nobody", "3:5", "not declared"},
    {"unknown_operator", abcq, "LD a\nNAND b", "3:1", "NAND is no operator"},
    {"missing_operand", abcq, "LD a\nAND", "3:1", "takes one operand"},
    {"operand_too_many", abcq, "LD a, b", "2:7", "takes one operand"},
    {"store_into_a_literal", abcq, "LD a\nST 5", "3:4", "literal"},
    {"store_into_an_input", abcq, "LD a\nST %IX0.0", "3:1", "physical input"},
    {"store_into_a_constant", "END_VAR VAR CONSTANT n : INT := 5;", "LD 1\nST n", "3:1", "a constant"},
    {"store_into_a_program_input", "END_VAR VAR_INPUT a : BOOL;", "LD TRUE\nST a", "3:1",
     "input of the program"},
    {"store_into_an_output_of_a_block", "t : TON;", "LD TRUE\nST t.Q", "3:1", "output of a function block"},
    {"block_as_a_value", "t : TON;", "LD t", "2:4", "T is a TON"},
    {"unknown_output", "t : TON;", "LD t.X", "2:4", "no input or output X"},
    {"unknown_type", "a : DATE;", "", "1:19", "no type of this PLC"},
    {"declared_twice", "a : BOOL; A : INT;", "", "1:25", "declared twice"},
    {"initial_value_that_does_not_fit", "a : INT := 40000;", "", "1:26", "does not fit INT"},
    {"bit_eight", abcq, "LD %IX0.8", "2:4", "0 to 7"},
    {"bit_without_a_byte", abcq, "LD %IX3", "2:4", "byte.bit"},
    {"unknown_area", abcq, "LD %ZX0.0", "2:4", "areas"},
    {"address_beyond_the_image", abcq, "LD %MW40000", "2:4", "at most 65536"},
    {"word_at_the_address_of_a_bit", "w AT %MX0.0 : WORD;", "", "1:20", "not the size"},
    {"retained_address", "END_VAR VAR RETAIN w AT %MW0 : WORD;", "", "1:39", "RETAIN or AT"},
    {"comment_without_end", abcq, "LD a\n  (* oh", "3:3", "no end"},
    {"strange_character", abcq, "LD a\nST q $", "3:6", "begins nothing"},
    {"semicolon_after_an_instruction", abcq, "LD a;", "2:5", "not with ;"},
    {"base_seven", ints, "LD 7#5", "2:4", "2, 8 or 16"},
    {"digit_beyond_the_base", ints, "LD 2#12", "2:4", "no digit of base 2"},
    {"two_underscores", ints, "LD 1__0", "2:4", "underscore"},
    {"duration_without_order", "t : TIME;", "LD T#1s2h", "2:4", "in this order"},
    {"fraction_in_the_middle", "t : TIME;", "LD T#1.5h3m", "2:4", "last part"},
    {"part_beyond_its_unit", "t : TIME;", "LD T#1m61s", "2:4", "first part"},
    {"typed_literal_that_does_not_fit", ints, "LD SINT#200", "2:4", "does not fit SINT"},
    {"closing_nothing", abcq, "LD a\n)", "3:1", "no parenthesis"},
    {"parenthesis_left_open", abcq, "LD a\nAND( b\nST q", "3:1", "not closed"},
    {"positional_and_named_mixed", "t : TON; a : BOOL;", "CAL t(a, PT := T#1s)", "2:6", "all parameters"},
    {"missing_parameter", ints, "LIMIT(MN := 0, MX := 5)", "2:1", "needs all"},
    {"unknown_parameter", ints, "LIMIT(MN := 0, INN := i, MX := 5)", "2:16", "no parameter INN"},
    {"too_many_inputs", "t : TON; a : BOOL;", "CAL t(a, T#1s, a)", "2:16", "only 2 inputs"},
    {"output_of_a_block_set_like_an_input", "t : TON; q : BOOL;", "CAL t(Q := q)", "2:7", "no input Q"},
    {"input_of_a_block_read_like_an_output", "t : TON; q : BOOL;", "CAL t(IN => q)", "2:7", "no output IN"},
    {"conversion_to_the_same_type", ints, "LD i\nINT_TO_INT", "3:1", "no operator, function"},
    {"negative_shift", "w : WORD;", "LD w\nSHL -1", "3:5", "does not fit"},
    {"input_operator_of_no_block", ints, "LD q\nCLK q", "3:5", "no instance"},
    {"call_not_closed", "t : TON; a : BOOL;", "CAL t(\nIN := a,", "4:1", "not an operand"},
    {"sel_of_two_untyped", ints, "LD q\nSEL 0, 1\nST i", "3:1", "neither literal"},
    {"shift_of_a_number", ints, "LD i\nSHL 2", "3:1", "BYTE, WORD"},
    {"dead_code_that_uses_cr", ints, "LD i\nRET\nST j", "4:1", "no way leads"},
};

class BadPrograms : public testing::TestWithParam<BadProgram> {};

TEST_P(BadPrograms, are_refused_at_their_mistake) {
  const Refusal refusal = refusal_of(GetParam().variables, GetParam().body);
  EXPECT_EQ(refusal.place, GetParam().place) << refusal.message;
  EXPECT_NE(refusal.message.find(GetParam().says), std::string::npos) << refusal.message;
}

INSTANTIATE_TEST_SUITE_P(Il, BadPrograms, testing::ValuesIn(bad_programs),
                         [](const auto& given) { return std::string{given.param.name}; });

/// Compiles, and runs one scan of what compiles.
void try_source(const std::string& source) {
  const auto program = compile(source);
  if (!program) {
    EXPECT_FALSE(program.error().message.empty()) << source;
    return;
  }
  IlMachine machine{*program};
  std::array<std::byte, 16> inputs{};
  std::array<std::byte, 16> outputs{};
  std::array<std::byte, 16> memory{};
  const auto scan = machine.run_scan({inputs, outputs, memory}, std::chrono::nanoseconds{0}, 1000);
  EXPECT_TRUE(scan || !to_string(scan.error()).empty());
}

TEST(IlCompiler, a_source_that_is_cut_off_or_lacks_a_byte_is_refused_or_runs_to_an_end) {
  for (const GoodProgram& program : good_programs) {
    const std::string source = program_of(program.variables, program.body);
    for (std::size_t i = 0; i < source.size(); ++i) {
      try_source(source.substr(0, i));
      try_source(source.substr(0, i) + source.substr(i + 1));
      try_source(source.substr(0, i) + "(" + source.substr(i));
    }
  }
}

}  // namespace
}  // namespace emulator_models::soft_plc
