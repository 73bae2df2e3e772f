// The options of the handoff, as both programs have them.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>

#include "protocol/handoff_command_line.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

using namespace std::chrono_literals;

class HandoffCommandLine : public testing::TestWithParam<HandoffSide> {
 protected:
  /// @return what is wrong; empty: it was taken
  std::string parse(std::vector<std::string> words) { return parse_as(GetParam(), std::move(words)); }
  std::string parse_as(HandoffSide side, std::vector<std::string> words) {
    CLI::App app;
    arguments_ = {};
    add_handoff_options(app, arguments_, side);
    std::reverse(words.begin(), words.end());
    try {
      app.parse(words);
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    options_ = arguments_.options();
    return {};
  }
  [[nodiscard]] const hardened::Options& hardened() const { return std::get<hardened::Options>(options_); }
  [[nodiscard]] const PaperOptions& paper() const { return std::get<PaperOptions>(options_); }

  HandoffArguments arguments_;
  HandoffOptions options_;
};

TEST_P(HandoffCommandLine, chooses_the_hardened_handoff_unless_told_otherwise) {
  EXPECT_EQ(parse({}), "");
  EXPECT_EQ(kind_of(options_), Handoff::hardened);
  EXPECT_EQ(hardened().doorbells, hardened::Options::Doorbells::two);
  EXPECT_EQ(hardened().request_bytes_max, 576U);
  EXPECT_EQ(parse({"--protocol", "hardened", "--doorbells", "one"}), "");
  EXPECT_EQ(hardened().doorbells, hardened::Options::Doorbells::one);
  EXPECT_EQ(parse({"--protocol", "paper"}), "");
  EXPECT_EQ(kind_of(options_), Handoff::paper);
  EXPECT_NE(parse({"--protocol", "other"}), "");
}

TEST_P(HandoffCommandLine, gives_both_handoffs_the_same_capacities) {
  EXPECT_EQ(parse({"--request-bytes-max", "600", "--response-bytes-max", "700"}), "");
  EXPECT_EQ(hardened().request_bytes_max, 600U);
  EXPECT_EQ(hardened().response_bytes_max, 700U);
  EXPECT_EQ(parse({"--request-bytes-max", "600", "--response-bytes-max", "65536", "--protocol", "paper"}),
            "");
  EXPECT_EQ(paper().request_bytes_max, 600U);
  EXPECT_EQ(paper().response_bytes_max, 65'536U);
  EXPECT_NE(parse({"--request-bytes-max", "0"}), "");
  EXPECT_NE(parse({"--response-bytes-max", "65537"}), "");
}

TEST_P(HandoffCommandLine, fills_what_the_published_handoff_leaves_open) {
  EXPECT_EQ(parse({"--protocol", "paper", "--state-coding", "halves", "--length-check", "load-once"}), "");
  EXPECT_EQ(paper().state_coding, PaperOptions::StateCoding::halves);
  EXPECT_EQ(paper().length_check, PaperOptions::LengthCheck::load_once);
}

TEST_P(HandoffCommandLine, refuses_an_option_of_the_other_handoff_and_names_the_way_out) {
  // In any order: nobody has to say first which handoff it is.
  for (const std::string option :
       {"--state-coding=halves", "--area-order=length-first", "--length-check=none", "--semaphore-start=zero",
        "--answer-order=as-published"}) {
    const std::string name = option.substr(0, option.find('='));
    const std::string refusal = name + ": belongs to the published handoff. Give --protocol paper, too";
    EXPECT_EQ(parse({option}), refusal);
    EXPECT_EQ(parse({option, "--protocol", "hardened"}), refusal);
    EXPECT_EQ(parse({option, "--protocol", "paper"}), "");
  }
  EXPECT_EQ(parse({"--doorbells", "two", "--protocol", "paper"}),
            "--doorbells: belongs to the hardened handoff. Leave it out, or --protocol paper");
}

INSTANTIATE_TEST_SUITE_P(Of, HandoffCommandLine, testing::Values(HandoffSide::kernel, HandoffSide::emulator),
                         [](const auto& side) {
                           return side.param == HandoffSide::kernel ? "the_kernel" : "the_emulator";
                         });

class HandoffSides : public HandoffCommandLine {};

TEST_F(HandoffSides, have_options_of_their_own) {
  for (const std::string option : {"--read-wait=poll", "--semaphore-maximum=one",
                                   "--state-taken-back=by-master", "--on-time-out=give-up"}) {
    EXPECT_EQ(parse_as(HandoffSide::kernel, {option, "--protocol=paper"}), "");
    EXPECT_NE(parse_as(HandoffSide::kernel, {option}), "");
    EXPECT_NE(parse_as(HandoffSide::emulator, {option, "--protocol=paper"}), "");
  }
  for (const std::string option : {"--semaphore-after-answer=wait", "--initialiser=creator"}) {
    EXPECT_EQ(parse_as(HandoffSide::emulator, {option, "--protocol=paper"}), "");
    EXPECT_NE(parse_as(HandoffSide::emulator, {option}), "");
    EXPECT_NE(parse_as(HandoffSide::kernel, {option, "--protocol=paper"}), "");
  }
}

TEST_F(HandoffSides, the_kernel_has_the_time_out_of_the_take_and_the_queries) {
  EXPECT_EQ(parse_as(HandoffSide::kernel, {}), "");
  EXPECT_EQ(hardened().take_timeout, 200ms);
  EXPECT_EQ(hardened().queries_max, 1U);
  EXPECT_EQ(parse_as(HandoffSide::kernel, {"--take-timeout-ms", "30", "--queries", "0"}), "");
  EXPECT_EQ(hardened().take_timeout, 30ms);
  EXPECT_EQ(hardened().queries_max, 0U);
  EXPECT_NE(parse_as(HandoffSide::kernel, {"--take-timeout-ms", "0"}), "");
  EXPECT_NE(parse_as(HandoffSide::kernel, {"--queries", "3", "--protocol", "paper"}), "");
  EXPECT_NE(parse_as(HandoffSide::emulator, {"--queries", "3"}), "");
}

// --- why there is no PLC ---

TEST(WhyNoPlc, tells_how_to_start_one_where_there_is_no_segment) {
  const TestSegment segment;
  EXPECT_EQ(why_no_plc(segment.name(), hardened::Options{}),
            "there is no such segment. Start one: plc-emulator --segment " + segment.name());
  EXPECT_EQ(
      why_no_plc(segment.name(), PaperOptions{}),
      "there is no such segment. Start one: plc-emulator --segment " + segment.name() + " --protocol paper");
}

TEST(WhyNoPlc, names_the_option_where_the_segment_has_the_other_handoff) {
  const TestSegment published;
  SlaveSharedMemoryWrapper paper_slave(published.name(), small_options());
  ASSERT_TRUE(paper_slave.open());
  EXPECT_EQ(why_no_plc(published.name(), small_options()), "");
  EXPECT_TRUE(why_no_plc(published.name(), hardened::Options{})
                  .starts_with("it has the published handoff. Give --protocol paper"));

  const hardened::HardenedSegment segment;
  hardened::Slave slave(segment.name(), hardened::impatient());
  ASSERT_TRUE(slave.open());
  EXPECT_EQ(why_no_plc(segment.name(), hardened::impatient()), "");
  EXPECT_TRUE(why_no_plc(segment.name(), PaperOptions{})
                  .starts_with("it has the hardened handoff. Leave out --protocol paper"));
}

}  // namespace
}  // namespace protocol
