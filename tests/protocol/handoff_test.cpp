// Which handoff a segment has, and who removes it in the end.

#include <gtest/gtest.h>

#include <string>

#include "protocol/handoff.hpp"
#include "protocol/hardened/master.hpp"
#include "protocol/hardened/named_memory.hpp"
#include "protocol/hardened/slave.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

const HandoffOptions paper = PaperOptions{};
const HandoffOptions hardened_default = hardened::Options{};

TEST(HandoffOptionsTest, are_of_one_handoff) {
  EXPECT_EQ(kind_of(paper), Handoff::paper);
  EXPECT_EQ(kind_of(hardened_default), Handoff::hardened);
  EXPECT_EQ(kind_of(HandoffOptions{}), Handoff::hardened) << "what nobody has chosen";
  EXPECT_EQ(name_of(Handoff::paper), "paper");
  EXPECT_EQ(name_of(Handoff::hardened), "hardened");
}

TEST(HandoffOfSegment, is_none_where_there_is_no_segment) {
  const TestSegment segment;
  EXPECT_EQ(handoff_of_segment(segment.name()), std::nullopt);
}

TEST(HandoffOfSegment, is_told_by_what_a_side_has_made) {
  const TestSegment published;
  SlaveSharedMemoryWrapper paper_slave(published.name(), small_options());
  ASSERT_TRUE(paper_slave.open());
  EXPECT_EQ(handoff_of_segment(published.name()), Handoff::paper);

  const hardened::HardenedSegment segment;
  {
    hardened::Slave slave(segment.name(), hardened::impatient());
    ASSERT_TRUE(slave.open());
    EXPECT_EQ(handoff_of_segment(segment.name()), Handoff::hardened);
  }
  EXPECT_EQ(handoff_of_segment(segment.name()), Handoff::hardened) << "left over";
}

TEST(HandoffOfSegment, is_known_from_the_first_object_on_that_is_made) {
  const hardened::HardenedSegment segment;
  hardened::Slave slave(segment.name(), hardened::impatient());
  ASSERT_TRUE(slave.open());
  slave.close();
  ASSERT_TRUE(hardened::NamedMemory::remove(segment.name()));
  EXPECT_EQ(handoff_of_segment(segment.name()), Handoff::hardened);
}

TEST(RemoveIfUnused, removes_a_hardened_segment_on_which_nobody_plays_a_role) {
  const hardened::HardenedSegment segment;
  hardened::Master master(segment.name(), hardened::impatient());
  ASSERT_TRUE(master.open());
  hardened::Slave slave(segment.name(), hardened::impatient());
  ASSERT_TRUE(slave.open());
  master.close();
  remove_if_unused(segment.name(), hardened_default);
  EXPECT_EQ(handoff_of_segment(segment.name()), Handoff::hardened) << "the emulator serves";
  slave.close();
  remove_if_unused(segment.name(), hardened_default);
  EXPECT_EQ(handoff_of_segment(segment.name()), std::nullopt);
}

TEST(RemoveIfUnused, leaves_a_published_segment_to_its_emulator) {
  const TestSegment segment;
  SlaveSharedMemoryWrapper slave(segment.name(), small_options());
  ASSERT_TRUE(slave.open());
  slave.close();
  remove_if_unused(segment.name(), paper);
  EXPECT_EQ(handoff_of_segment(segment.name()), Handoff::paper);
}

}  // namespace
}  // namespace protocol
