// A configuration over the wire: whole and right, or not at all.
#include "emulator_models/soft_plc/configuration_transfer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace emulator_models::soft_plc {
namespace {

using Begin = ConfigurationTransfer::Begin;
using Chunk = ConfigurationTransfer::Chunk;
using Commit = ConfigurationTransfer::Commit;

struct Wire {
  std::vector<std::string> loaded;
  ConfigurationTransfer transfer{[this](std::string_view text) -> tl::expected<void, std::string> {
    loaded.emplace_back(text);
    return {};
  }};
};

constexpr std::uint32_t sum_of_123456789 = 0xCBF43926;  // the check value of the catalogues of CRCs

TEST(ConfigurationTransfer, a_text_in_chunks_is_loaded_on_commit_and_not_before) {
  Wire wire;
  ASSERT_TRUE(wire.transfer.serve(Begin{9, sum_of_123456789}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{0, "1234"}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{4, "56789"}));
  EXPECT_TRUE(wire.loaded.empty());
  ASSERT_TRUE(wire.transfer.serve(Commit{sum_of_123456789}));
  EXPECT_EQ(wire.loaded, std::vector<std::string>{"123456789"});
}

TEST(ConfigurationTransfer, a_damaged_or_short_text_is_never_loaded) {
  Wire wire;
  for (const char* text : {"123456788", "12345678", ""}) {
    ASSERT_TRUE(wire.transfer.serve(Begin{9, sum_of_123456789}));
    ASSERT_TRUE(wire.transfer.serve(Chunk{0, text}));
    EXPECT_FALSE(wire.transfer.serve(Commit{sum_of_123456789}));
    EXPECT_FALSE(wire.transfer.serve(Commit{sum_of_123456789})) << "nothing is left of it";
  }
  EXPECT_TRUE(wire.loaded.empty());
}

// I3
TEST(ConfigurationTransfer, a_new_begin_drops_what_has_come_before) {
  Wire wire;
  ASSERT_TRUE(wire.transfer.serve(Begin{9, sum_of_123456789}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{0, "12"}));
  ASSERT_TRUE(wire.transfer.serve(Begin{9, sum_of_123456789}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{0, "123456789"}));
  EXPECT_TRUE(wire.transfer.serve(Commit{sum_of_123456789}));
}

TEST(ConfigurationTransfer, chunks_out_of_order_doubled_or_too_long_are_refused) {
  Wire wire;
  EXPECT_FALSE(wire.transfer.serve(Chunk{0, "1"})) << "no begin";
  EXPECT_FALSE(wire.transfer.serve(Begin{0, 0}));
  EXPECT_FALSE(wire.transfer.serve(Begin{1'048'577, 0}));
  ASSERT_TRUE(wire.transfer.serve(Begin{9, sum_of_123456789}));
  EXPECT_FALSE(wire.transfer.serve(Chunk{1, "2"}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{0, "1"}));
  EXPECT_FALSE(wire.transfer.serve(Chunk{0, "1"}));
  EXPECT_FALSE(wire.transfer.serve(Chunk{1, "234567890"}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{1, "23456789"})) << "what was refused has changed nothing";
  EXPECT_TRUE(wire.transfer.serve(Commit{sum_of_123456789}));
}

// I4
TEST(ConfigurationTransfer, nobody_commits_the_text_of_another) {
  Wire wire;
  ASSERT_TRUE(wire.transfer.serve(Begin{1, crc32("1")}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{0, "1"}));
  ASSERT_TRUE(wire.transfer.serve(Begin{1, crc32("2")}));
  ASSERT_TRUE(wire.transfer.serve(Chunk{0, "2"}));
  EXPECT_FALSE(wire.transfer.serve(Commit{crc32("1")}));
  EXPECT_TRUE(wire.loaded.empty());
  EXPECT_TRUE(wire.transfer.serve(Commit{crc32("2")})) << "the other one goes on";
  EXPECT_EQ(wire.loaded, std::vector<std::string>{"2"});
}

}  // namespace
}  // namespace emulator_models::soft_plc
