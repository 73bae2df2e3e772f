// The machine table as a file: the shipped one is what is built in, and a bad one is refused with its place.
#include "kernel_mocks/machine_table_file.hpp"

#include <gtest/gtest.h>

#include "kernel_mocks/operator_script_file.hpp"
#include "kernel_mocks/part_program_file.hpp"

namespace kernel_mocks {
namespace {

std::string refusal(std::string_view text) {
  const auto table = parse_machine_table(text);
  return table ? "" : to_string(table.error());
}

TEST(MachineTableFile, the_shipped_file_is_the_table_that_is_built_in) {
  const auto table = parse_machine_table(read_program_file(MACHINE_TABLE_FILE).value());
  ASSERT_TRUE(table.has_value()) << to_string(table.error());
  EXPECT_TRUE(*table == MachineTable::standard());
}

TEST(MachineTableFile, a_kind_that_contradicts_its_effect_is_refused_with_line_and_column) {
  EXPECT_TRUE(refusal("[[function]]\nm = 3\neffect = \"end\"\nsynchronisation = \"MVS_SVS\"\n")
                  .starts_with("line 4, column 19: this synchronisation contradicts"));
}

TEST(MachineTableFile, a_kind_that_this_kernel_has_not_is_refused_with_those_it_has) {
  EXPECT_EQ(
      refusal("[[function]]\nm = 3\neffect = \"end\"\nsynchronisation = \"MNE_SNS\"\n"),
      "line 4, column 19: 'synchronisation' is one of NO_SYNCH, MOS, MVS_SVS, MVS_SNS, MNS_SNS, MVS_SLM");
}

TEST(MachineTableFile, keys_within_keys_without_end_are_refused_and_do_not_overflow_the_stack) {
  std::string keys;
  for (int i = 0; i < 300'000; ++i) keys += "a.";
  EXPECT_EQ(refusal(keys + "a = 1\n"),
            "line 1, column 16: this nests deeper than 8 levels; the file is tables of [[function]]");
}

TEST(OperatorScriptFile, reads_times_and_blocks) {
  const auto script = parse_operator_script(
      "[[event]]\nat_ms = 5\npress = \"feed-hold\"\n[[event]]\nblock = 20\npress = \"reset\"\n");
  ASSERT_TRUE(script.has_value());
  EXPECT_EQ(*script, (OperatorScript{{std::chrono::nanoseconds{5'000'000}, OperatorEvent::feed_hold},
                                     {std::uint32_t{20}, OperatorEvent::reset}}));
}

}  // namespace
}  // namespace kernel_mocks
