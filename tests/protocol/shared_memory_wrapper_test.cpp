// Creating, opening and removing the named objects; K5 and K10.

#include <gtest/gtest.h>
#include <boost/interprocess/shared_memory_object.hpp>

#include "protocol/master_shared_memory_wrapper.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

using Initialiser = PaperOptions::Initialiser;
using SemaphoreStart = PaperOptions::SemaphoreStart;

/// A segment and a semaphore from a former life: 'x' everywhere, and two posts that nobody consumed.
void leave_objects_behind(const std::string& name) {
  MasterSharedMemoryWrapper former(name, small_options());
  ASSERT_TRUE(former.open());
  ASSERT_TRUE(former.write(bytes("one")));
  ASSERT_TRUE(former.write(bytes("two")));
  RawSegment(name).set_text(0, std::string(RawSegment(name).size_bytes(), 'x'));
}

TEST(SharedMemoryWrapper, makes_the_named_objects_when_there_are_none) {
  const TestSegment segment;
  EXPECT_FALSE(SharedMemoryWrapper::exists(segment.name()));
  MasterSharedMemoryWrapper master(segment.name(), small_options());
  ASSERT_TRUE(master.open());
  EXPECT_TRUE(master.created_segment());
  EXPECT_TRUE(SharedMemoryWrapper::exists(segment.name()));
  EXPECT_EQ(RawSegment(segment.name()).size_bytes(), 28u);
  EXPECT_EQ(take_all_tokens(segment.name()), 0u);
}

TEST(SharedMemoryWrapper, opens_the_named_objects_that_exist) {
  const TestSegment segment;
  SlaveSharedMemoryWrapper slave(segment.name(), small_options());
  MasterSharedMemoryWrapper master(segment.name(), small_options());
  ASSERT_TRUE(slave.open());
  ASSERT_TRUE(master.open());
  EXPECT_TRUE(slave.created_segment());
  EXPECT_FALSE(master.created_segment());
}

TEST(SharedMemoryWrapper, leaves_the_named_objects_behind_when_it_closes) {
  const TestSegment segment;
  MasterSharedMemoryWrapper master(segment.name(), small_options());
  ASSERT_TRUE(master.open());
  master.close();
  master.close();
  EXPECT_FALSE(master.is_open());
  EXPECT_TRUE(SharedMemoryWrapper::exists(segment.name()));
}

TEST(SharedMemoryWrapper, can_be_opened_twice_and_again_after_closing) {
  const TestSegment segment;
  MasterSharedMemoryWrapper master(segment.name(), small_options());
  ASSERT_TRUE(master.open());
  ASSERT_TRUE(master.open());
  master.close();
  ASSERT_TRUE(master.open());
  EXPECT_TRUE(master.is_open());
}

TEST(SharedMemoryWrapper, removes_both_named_objects) {
  const TestSegment segment;
  leave_objects_behind(segment.name());
  EXPECT_TRUE(SharedMemoryWrapper::remove(segment.name()));
  EXPECT_FALSE(SharedMemoryWrapper::exists(segment.name()));
  EXPECT_FALSE(SharedMemoryWrapper::remove(segment.name()));
}

TEST(SharedMemoryWrapper, sees_a_semaphore_that_lost_its_segment) {
  const TestSegment segment;
  leave_objects_behind(segment.name());
  ASSERT_TRUE(boost::interprocess::shared_memory_object::remove(segment.name().c_str()));
  EXPECT_TRUE(SharedMemoryWrapper::exists(segment.name()));
}

TEST(SharedMemoryWrapper, refuses_a_name_that_the_system_refuses) {
  MasterSharedMemoryWrapper nested("no/such/folder", small_options());
  EXPECT_EQ(nested.open(), tl::make_unexpected(SharedMemoryError::cannot_open));
  MasterSharedMemoryWrapper overlong(std::string(1000, 'n'), small_options());
  EXPECT_EQ(overlong.open(), tl::make_unexpected(SharedMemoryError::cannot_open));
  EXPECT_FALSE(overlong.is_open());
}

TEST(SharedMemoryWrapper, refuses_a_segment_that_has_no_room_for_the_areas) {
  const TestSegment segment;
  leave_objects_behind(segment.name());
  PaperOptions options = small_options();
  options.response_bytes_max += 1;
  MasterSharedMemoryWrapper master(segment.name(), options);
  EXPECT_EQ(master.open(), tl::make_unexpected(SharedMemoryError::segment_too_small));
  EXPECT_FALSE(master.is_open());
}

TEST(SharedMemoryWrapper, accepts_a_segment_that_is_larger_than_needed) {
  const TestSegment segment;
  leave_objects_behind(segment.name());
  PaperOptions options = small_options();
  options.response_bytes_max = 4;
  MasterSharedMemoryWrapper master(segment.name(), options);
  EXPECT_TRUE(master.open());
}

TEST(SharedMemoryWrapper, gives_its_size_to_a_segment_whose_creator_died_before_doing_so) {
  const TestSegment segment;
  boost::interprocess::shared_memory_object(boost::interprocess::create_only, segment.name().c_str(),
                                            boost::interprocess::read_write);
  MasterSharedMemoryWrapper master(segment.name(), small_options());
  ASSERT_TRUE(master.open());
  EXPECT_TRUE(master.created_segment());
  EXPECT_EQ(RawSegment(segment.name()).size_bytes(), 28u);
}

class Initialisation : public testing::TestWithParam<Initialiser> {};

TEST_P(Initialisation, a_fresh_segment_is_all_zero) {
  const TestSegment segment;
  PaperOptions options = small_options();
  options.initialiser = GetParam();
  SlaveSharedMemoryWrapper slave(segment.name(), options);
  ASSERT_TRUE(slave.open());
  EXPECT_EQ(RawSegment(segment.name()).text(0, 28), std::string(28, '\0'));
}

TEST_P(Initialisation, a_master_leaves_the_contents_of_a_segment_that_exists) {
  const TestSegment segment;
  leave_objects_behind(segment.name());
  PaperOptions options = small_options();
  options.initialiser = GetParam();
  MasterSharedMemoryWrapper master(segment.name(), options);
  ASSERT_TRUE(master.open());
  EXPECT_EQ(RawSegment(segment.name()).text(0, 28), std::string(28, 'x'));
}

TEST_P(Initialisation, a_slave_wipes_a_segment_that_exists_only_when_told_to) {  // H10
  const TestSegment segment;
  leave_objects_behind(segment.name());
  PaperOptions options = small_options();
  options.initialiser = GetParam();
  SlaveSharedMemoryWrapper slave(segment.name(), options);
  ASSERT_TRUE(slave.open());
  const bool wipes = GetParam() == Initialiser::slave || GetParam() == Initialiser::creator_and_slave;
  EXPECT_EQ(RawSegment(segment.name()).text(0, 28), std::string(28, wipes ? '\0' : 'x'));
}

INSTANTIATE_TEST_SUITE_P(K5, Initialisation,
                         testing::Values(Initialiser::creator, Initialiser::slave,
                                         Initialiser::creator_and_slave, Initialiser::nobody));

/// @return tokens in the semaphore after a master with this K10 has opened the objects
unsigned tokens_after_opening(const std::string& name, SemaphoreStart start) {
  PaperOptions options = small_options();
  options.semaphore_start = start;
  MasterSharedMemoryWrapper master(name, options);
  EXPECT_TRUE(master.open());
  return take_all_tokens(name);
}

struct SemaphoreCase {
  SemaphoreStart start;
  unsigned fresh_count;
  unsigned left_over_without_segment_count;
};

class SemaphoreCount : public testing::TestWithParam<SemaphoreCase> {};

TEST_P(SemaphoreCount, of_a_fresh_semaphore) {
  const TestSegment segment;
  EXPECT_EQ(tokens_after_opening(segment.name(), GetParam().start), GetParam().fresh_count);
}

TEST_P(SemaphoreCount, of_a_semaphore_that_outlived_its_segment) {
  const TestSegment segment;
  leave_objects_behind(segment.name());
  ASSERT_TRUE(boost::interprocess::shared_memory_object::remove(segment.name().c_str()));
  EXPECT_EQ(tokens_after_opening(segment.name(), GetParam().start),
            GetParam().left_over_without_segment_count);
}

TEST_P(SemaphoreCount, is_left_alone_when_both_objects_exist) {  // the peer's posts are in it
  const TestSegment segment;
  leave_objects_behind(segment.name());
  EXPECT_EQ(tokens_after_opening(segment.name(), GetParam().start), 2u);
}

INSTANTIATE_TEST_SUITE_P(K10, SemaphoreCount,
                         testing::Values(SemaphoreCase{SemaphoreStart::zero, 0, 0},
                                         SemaphoreCase{SemaphoreStart::one, 1, 1},
                                         SemaphoreCase{SemaphoreStart::left_over, 0, 2}));

}  // namespace
}  // namespace protocol
