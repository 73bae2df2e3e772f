// One test for each rule of instruction list, edition 2, named after it. Programs begin at line 2.
#include <sstream>

#include <gtest/gtest.h>

#include "emulator_models/soft_plc/il_parser.hpp"
#include "tests/emulator_models/soft_plc/il_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

constexpr const char* some = "a, b, q : BOOL; i, j : INT; d : DINT; w : WORD; x : REAL; t : TON; c : CTU;";

std::string place_of_refusal(std::string_view body) { return refusal_of(some, body).place; }

std::string result_of(std::string_view body, std::string_view steps) { return IlRig{some, body}.run(steps); }

/// `body` holds OP where the operator goes.
std::string with(std::string body, std::string_view operation) {
  for (std::size_t at = 0; (at = body.find("OP", at)) != std::string::npos; at += operation.size())
    body.replace(at, 2, operation);
  return body;
}

TEST(IlRule, an_instruction_stands_on_a_line_of_its_own) {
  EXPECT_EQ(place_of_refusal("LD a ST q"), "2:6");
  EXPECT_EQ(place_of_refusal("LD a\nST q"), "compiled");
}

TEST(IlRule, a_comment_is_a_blank_and_does_not_nest) {
  EXPECT_EQ(result_of("LD (* one (* still one *) a\nST q", "a=1 -> q=1"), "");
  EXPECT_EQ(place_of_refusal("LD (* (* *) *) a"), "2:13");
}

TEST(IlRule, slashes_begin_no_comment) { EXPECT_EQ(place_of_refusal("LD a // no\nST q"), "2:6"); }

TEST(IlRule, keywords_and_names_are_the_same_in_any_case) {
  EXPECT_EQ(result_of("Ld A\njmpc ThE_zone\nret\ntHe_ZONE: st Q", "a=1 -> q=1"), "");
}

TEST(IlRule, operators_cannot_be_variables) {
  EXPECT_EQ(refusal_of("r : BOOL;", "").place, "1:15");
  EXPECT_EQ(refusal_of("s : BOOL;", "").place, "1:15");
  EXPECT_EQ(refusal_of("q : BOOL;", "").place, "compiled");
}

TEST(IlRule, a_label_may_stand_on_a_line_of_its_own) {
  EXPECT_EQ(result_of("LD a\nJMP on\non:\n\nST q", "a=1 -> q=1"), "");
}

TEST(IlRule, an_unknown_label_is_refused) { EXPECT_EQ(place_of_refusal("JMP nowhere"), "2:5"); }

TEST(IlRule, a_label_stands_once) { EXPECT_EQ(place_of_refusal("l: LD a\nL: LD b"), "3:1"); }

TEST(IlRule, no_jump_out_of_a_parenthesis) {
  EXPECT_EQ(place_of_refusal("LD a\nAND( b\nJMPC out\n)\nout: ST q"), "4:1");
  EXPECT_EQ(place_of_refusal("LD a\nAND( b\nRETC\n)\nST q"), "4:1");
}

TEST(IlRule, no_jump_into_a_parenthesis) {
  EXPECT_EQ(place_of_refusal("LD a\nJMP in\nAND( b\nin: OR b\n)\nST q"), "5:1");
}

TEST(IlRule, no_call_of_a_block_within_a_parenthesis) {
  EXPECT_EQ(place_of_refusal("LD a\nAND( b\nCAL t\n)\nST q"), "4:1");
}

TEST(IlRule, ld_takes_any_type_and_ldn_bits_only) {
  for (const char* const name : {"a", "i", "d", "w", "x", "t.ET"})
    EXPECT_EQ(place_of_refusal(std::string{"LD "} + name), "compiled") << name;
  EXPECT_EQ(place_of_refusal("LDN a"), "compiled");
  EXPECT_EQ(place_of_refusal("LDN w"), "compiled");
  EXPECT_EQ(place_of_refusal("LDN i"), "2:1");
  EXPECT_EQ(place_of_refusal("LDN x"), "2:1");
}

TEST(IlRule, st_needs_the_type_of_its_target) {
  EXPECT_EQ(place_of_refusal("LD i\nST j"), "compiled");
  EXPECT_EQ(place_of_refusal("LD i\nST d"), "3:1");
  EXPECT_EQ(place_of_refusal("LD i\nST w"), "3:1");
  EXPECT_EQ(place_of_refusal("LD i\nSTN j"), "3:1");
}

TEST(IlRule, st_and_stn_leave_the_cr) {
  EXPECT_EQ(result_of("LD a\nST b\nSTN q\nST b", "a=1 -> b=1 q=0 ; a=0 -> b=0 q=1"), "");
}

TEST(IlRule, s_and_r_act_when_cr_is_true_and_leave_it) {
  EXPECT_EQ(result_of("LD a\nS b\nST q", "a=1 -> b=1 q=1 ; a=0 -> b=1 q=0"), "");
  EXPECT_EQ(result_of("LD a\nR b\nST q", "b=1 -> b=1 q=0 ; a=1 -> b=0 q=1"), "");
}

TEST(IlRule, s_and_r_need_bool_on_both_sides) {
  EXPECT_EQ(place_of_refusal("LD i\nS q"), "3:1");
  EXPECT_EQ(place_of_refusal("LD a\nS i"), "3:3");
  EXPECT_EQ(place_of_refusal("LD w\nR q"), "3:1");
}

TEST(IlRule, and_or_xor_take_bits_of_equal_width) {
  for (const char* const operation : {"AND", "ANDN", "OR", "ORN", "XOR", "XORN"}) {
    EXPECT_EQ(place_of_refusal(with("LD w\nOP w", operation)), "compiled");
    EXPECT_EQ(place_of_refusal(with("LD a\nOP b", operation)), "compiled");
    EXPECT_EQ(place_of_refusal(with("LD w\nOP a", operation)), "3:1");
    EXPECT_NE(place_of_refusal(with("LD w\nOP BYTE#1", operation)), "compiled");
    EXPECT_EQ(place_of_refusal(with("LD i\nOP j", operation)), "3:1");
  }
}

TEST(IlRule, not_takes_bits_and_no_operand) {
  EXPECT_EQ(place_of_refusal("LD a\nNOT"), "compiled");
  EXPECT_EQ(place_of_refusal("LD w\nNOT"), "compiled");
  EXPECT_EQ(place_of_refusal("LD i\nNOT"), "3:1");
  EXPECT_EQ(place_of_refusal("LD a\nNOT b"), "3:5");
}

TEST(IlRule, arithmetic_takes_numbers) {
  for (const char* const operation : {"ADD", "SUB", "MUL", "DIV"}) {
    EXPECT_EQ(place_of_refusal(with("LD i\nOP j", operation)), "compiled");
    EXPECT_EQ(place_of_refusal(with("LD x\nOP x", operation)), "compiled");
    EXPECT_EQ(place_of_refusal(with("LD w\nOP w", operation)), "3:1");
    EXPECT_EQ(place_of_refusal(with("LD a\nOP b", operation)), "3:1");
  }
}

TEST(IlRule, mod_takes_integers) {
  EXPECT_EQ(place_of_refusal("LD i\nMOD j"), "compiled");
  EXPECT_EQ(place_of_refusal("LD x\nMOD x"), "3:1");
}

TEST(IlRule, time_has_add_and_sub_only) {
  EXPECT_EQ(place_of_refusal("LD t.ET\nADD T#1s\nSUB t.PT"), "compiled");
  EXPECT_EQ(place_of_refusal("LD t.ET\nMUL T#2s"), "3:1");
  EXPECT_EQ(place_of_refusal("LD t.ET\nADD i"), "3:1");
}

TEST(IlRule, comparisons_take_any_equal_types_and_give_bool) {
  for (const char* const operation : {"GT", "GE", "EQ", "NE", "LE", "LT"}) {
    for (const char* const name : {"a", "i", "d", "w", "x", "t.ET"}) {
      const std::string body = std::string{"LD "} + name + "\n" + operation + " " + name + "\nST q";
      EXPECT_EQ(place_of_refusal(body), "compiled") << body;
    }
    EXPECT_EQ(place_of_refusal(with("LD i\nOP d", operation)), "3:1");
    EXPECT_EQ(place_of_refusal(with("LD i\nOP j\nST i", operation)), "4:1");
  }
}

TEST(IlRule, there_is_no_implicit_conversion) {
  EXPECT_EQ(place_of_refusal("LD i\nADD d"), "3:1");
  EXPECT_EQ(place_of_refusal("LD i\nADD x"), "3:1");
  EXPECT_EQ(place_of_refusal("LD x\nADD 1"), "3:5");
  EXPECT_EQ(place_of_refusal("LD w\nAND a"), "3:1");
}

TEST(IlRule, n_negates_the_operand_and_not_the_cr) {
  EXPECT_EQ(result_of("LD a\nORN b\nST q", "a=1 b=1 -> q=1"), "");   // NOT (a OR b) would be 0
  EXPECT_EQ(result_of("LD a\nANDN b\nST q", "a=0 b=1 -> q=0"), "");  // NOT (a AND b) would be 1
}

TEST(IlRule, n_of_an_opening_parenthesis_negates_its_whole_value) {
  EXPECT_EQ(result_of("LD TRUE\nANDN( a\nOR b\n)\nST q", "a=1 -> q=0 ; a=0 b=1 -> q=0 ; b=0 -> q=1"), "");
}

TEST(IlRule, n_exists_where_an_operand_can_be_negated_only) {
  EXPECT_EQ(place_of_refusal("LD i\nADDN j"), "3:1");
  EXPECT_EQ(place_of_refusal("LD i\nGTN j"), "3:1");
  EXPECT_EQ(place_of_refusal("LD a\nSN q"), "3:1");
}

TEST(IlRule, a_parenthesis_puts_its_operator_off) {
  EXPECT_EQ(result_of("LD 10\nSUB( i\nMUL 2\n)\nST j", "i=3 -> j=4"), "");
}

TEST(IlRule, a_parenthesis_begins_with_ld_or_its_short_form) {
  EXPECT_EQ(result_of("LD a\nAND(\nLD b\n)\nST q", "a=1 b=1 -> q=1"), "");
  EXPECT_EQ(result_of("LD a\nAND( b\n)\nST q", "a=1 b=1 -> q=1"), "");
  EXPECT_EQ(place_of_refusal("LD a\nAND(\nOR b\n)\nST q"), "4:1");
}

TEST(IlRule, both_sides_of_a_parenthesis_have_one_type) {
  EXPECT_EQ(place_of_refusal("LD i\nADD( d\nMUL 2\n)\nST i"), "5:1");
}

TEST(IlRule, parentheses_nest_to_their_limit_and_not_deeper) {
  const auto nested = [](std::size_t depth) {
    std::string body{"LD a"};
    for (std::size_t i = 0; i < depth; ++i) body.append("\nAND( a");
    for (std::size_t i = 0; i < depth; ++i) body.append("\n)");
    return body + "\nST q";
  };
  EXPECT_EQ(result_of(nested(nesting_max), "a=1 -> q=1 ; a=0 -> q=0"), "");
  EXPECT_EQ(place_of_refusal(nested(nesting_max + 1)), std::to_string(3 + nesting_max) + ":1");
}

TEST(IlRule, jmpc_calc_and_retc_need_bool) {
  for (const char* const operation : {"JMPC l", "JMPCN l", "CALC t", "CALCN t", "RETC", "RETCN"}) {
    EXPECT_EQ(place_of_refusal(with("LD a\nOP\nl: LD a", operation)), "compiled") << operation;
    EXPECT_EQ(place_of_refusal(with("LD i\nOP\nl: LD a", operation)), "3:1") << operation;
  }
}

TEST(IlRule, conditional_jumps_and_returns_act_on_their_own_value_only) {
  EXPECT_EQ(result_of("LD a\nJMPC l\nS q\nLD TRUE\nS b\nl: LD a", "a=1 -> b=0 ; a=0 -> b=1"), "");
  EXPECT_EQ(result_of("LD a\nJMPCN l\nS b\nl: LD a", "a=0 -> b=0 ; a=1 -> b=1"), "");
}

TEST(IlRule, jmp_leaves_the_cr) {
  EXPECT_EQ(result_of("LD a\nJMP l\nLD b\nl: ST q", "a=1 -> q=1 ; a=0 b=1 -> q=0"), "");
}

TEST(IlRule, the_cr_at_a_label_is_what_all_ways_agree_on) {
  EXPECT_EQ(place_of_refusal("LD a\nJMPC l\nLD i\nl: ST q"), "5:4");
  EXPECT_EQ(place_of_refusal("LD a\nJMPC l\nLD b\nl: ST q"), "compiled");
  // The way back brings an INT, which nobody uses.
  EXPECT_EQ(place_of_refusal("LD a\nl: LD i\nADD 1\nST i\nJMP l"), "compiled");
  EXPECT_EQ(place_of_refusal("LD a\nl: ST q\nLD i\nJMP l"), "3:4");
}

TEST(IlRule, a_label_reached_from_below_only_takes_the_cr_from_there) {
  EXPECT_EQ(result_of("JMP down\nup: ST q\nRET\ndown: LD a\nJMP up", "a=1 -> q=1 ; a=0 -> q=0"), "");
}

TEST(IlRule, a_label_reached_from_below_over_others_takes_the_cr_from_there) {
  EXPECT_EQ(result_of("JMP down\nfirst: ST q\nRET\nsecond: JMP first\ndown: LD a\nJMP second",
                      "a=1 -> q=1 ; a=0 -> q=0"),
            "");
}

TEST(IlRule, every_use_of_a_cr_that_comes_from_below_waits_for_it) {
  for (const char* const use : {"AND b", "AND( b\n)", "CALC t(IN := b)", "CALCN t", "SEL i, j", "JMPC out",
                                "RETCN", "CLK e", "NOT", "S q"}) {
    const std::string body = std::string{"JMP down\nup: "} + use + "\nRET\ndown: LD a\nJMP up\nout: LD a";
    EXPECT_EQ(refusal_of("a, b, q : BOOL; i, j : INT; t : TON; e : R_TRIG;", body).message, "compiled")
        << use;
  }
}

TEST(IlRule, the_cr_is_not_used_before_it_is_set) {
  EXPECT_EQ(place_of_refusal("ST q"), "2:1");
  EXPECT_EQ(place_of_refusal("AND a"), "2:1");
  EXPECT_EQ(place_of_refusal("AND( a\n)"), "2:1");
  EXPECT_EQ(place_of_refusal("MAX i"), "2:1");
  EXPECT_EQ(place_of_refusal("RETC"), "2:1");
}

TEST(IlRule, cal_leaves_the_cr_and_its_use_is_warned_of) {
  IlRig rig{some, "LD a\nCAL t(IN := b, PT := T#1s)\nST q"};
  EXPECT_EQ(rig.run("a=1 -> q=1 ; a=0 b=1 -> q=0"), "");
  ASSERT_EQ(rig.program().warnings.size(), 1U);
  EXPECT_EQ(rig.program().warnings.front().place, (SourcePlace{4, 1}));
  EXPECT_TRUE((IlRig{some, "LD a\nCAL t\nLD b\nST q"}.program().warnings.empty()));
}

TEST(IlRule, the_cr_is_the_first_argument_of_a_function) {
  EXPECT_EQ(result_of("LD i\nMAX j\nST i", "i=3 j=8 -> i=8"), "");
}

TEST(IlRule, a_function_in_formal_form_takes_no_cr_and_sets_it) {
  EXPECT_EQ(result_of("MAX(\nIN1 := i,\nIN2 := j\n)\nST i", "i=3 j=8 -> i=8"), "");
}

TEST(IlRule, min_and_max_take_any_number_of_arguments_and_16_named_ones) {
  EXPECT_EQ(result_of("LD 1\nMAX i, j, 4\nST i", "i=3 j=8 -> i=8 ; i=2 j=3 -> i=4"), "");
  const auto call = [](int count) {
    std::ostringstream body;
    body << "MAX(";
    for (int n = 1; n <= count; ++n) body << (n > 1 ? ", IN" : "IN") << n << " := " << (n == 9 ? "j" : "i");
    body << ")\nST i";
    return body.str();
  };
  EXPECT_EQ(result_of(call(16), "i=3 j=8 -> i=8"), "");
  EXPECT_EQ(place_of_refusal(call(17)), "2:1");
}

TEST(IlRule, a_block_is_called_in_four_forms) {
  for (const char* const call :
       {"CAL t(\nIN := a,\nPT := T#10ms,\nQ => q\n)", "CAL t(a, T#10ms)\nLD t.Q\nST q",
        "LD a\nST t.IN\nLD T#10ms\nST t.PT\nCAL t\nLD t.Q\nST q",
        "LD T#10ms\nPT t\nLD a\nIN t\nLD t.Q\nST q"}) {
    EXPECT_EQ(result_of(call, "a=1 -> q=0 ; -> q=1 ; a=0 -> q=0"), "") << call;
  }
}

TEST(IlRule, an_input_operator_stores_the_cr_and_calls) {
  EXPECT_EQ(result_of("LD 2\nPV c\nLD a\nCU c\nLD c.CV\nST i\nLD b\nR c",
                      "a=1 -> i=1 ; a=0 b=1 -> i=1 ; b=0 -> i=0"),
            "");
  EXPECT_EQ(place_of_refusal("LD i\nCU c"), "3:1");
  EXPECT_EQ(place_of_refusal("LD a\nCD c"), "3:1");
}

TEST(IlRule, ld_of_a_block_is_a_load_and_no_input_operator) {
  EXPECT_EQ(refusal_of("c : CTD;", "LD TRUE\nLD c").place, "3:4");
}

TEST(IlRule, an_instance_that_is_not_called_keeps_its_outputs_and_sees_no_time) {
  EXPECT_EQ(result_of("LD b\nCALC t(IN := TRUE, PT := T#10ms)\nLD t.Q\nST q",
                      "b=1 -> q=0 ; b=0 -> q=0 ; -> q=0 ; b=1 -> q=1 ; b=0 -> q=1"),
            "");
}

TEST(IlRule, an_untyped_literal_takes_the_type_of_its_context_and_must_fit) {
  EXPECT_EQ(place_of_refusal("LD 40000\nST i"), "2:4");
  EXPECT_EQ(place_of_refusal("LD 40000\nST d"), "compiled");
  EXPECT_EQ(place_of_refusal("LD i\nADD 40000"), "3:5");
  EXPECT_EQ(place_of_refusal("LD 1\nST q"), "compiled");
  EXPECT_EQ(place_of_refusal("LD 2\nST q"), "2:4");
  EXPECT_EQ(place_of_refusal("LD 5\nADD d\nST d"), "compiled");
}

TEST(IlRule, a_typed_literal_keeps_its_type) {
  EXPECT_EQ(place_of_refusal("LD INT#5\nST i"), "compiled");
  EXPECT_EQ(place_of_refusal("LD INT#5\nST d"), "3:1");
  EXPECT_EQ(place_of_refusal("LD i\nADD DINT#5"), "3:5");
}

TEST(IlRule, division_by_a_literal_zero_is_refused) {
  EXPECT_EQ(place_of_refusal("LD i\nDIV 0"), "3:5");
  EXPECT_EQ(place_of_refusal("LD i\nMOD INT#0"), "3:5");
  EXPECT_EQ(place_of_refusal("LD x\nDIV 0.0"), "3:5");
  EXPECT_EQ(place_of_refusal("LD i\nADD 0"), "compiled");
}

TEST(IlRule, a_program_has_a_name_and_an_end) {
  const auto refused_at = [](std::string_view source) {
    const auto tree = parse(source);
    return tree ? std::string{"parsed"}
                : std::to_string(tree.error().place.line) + ":" + std::to_string(tree.error().place.column);
  };
  EXPECT_EQ(refused_at("PROGRAM p\nEND_PROGRAM"), "parsed");
  EXPECT_EQ(refused_at("LD a"), "1:1");
  EXPECT_EQ(refused_at("PROGRAM\nEND_PROGRAM"), "1:8");
  EXPECT_EQ(refused_at("PROGRAM p\nLD a"), "2:5");
  EXPECT_EQ(refused_at("PROGRAM p\nEND_PROGRAM\nLD a"), "3:1");
  EXPECT_EQ(refused_at("PROGRAM p\nVAR a : BOOL;"), "2:1");
  EXPECT_EQ(refused_at(""), "1:1");
}

}  // namespace
}  // namespace emulator_models::soft_plc
