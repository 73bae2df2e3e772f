// One master and one slave on a segment, and none after its process has died; named objects that are there, or not, or
// of another kind.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <latch>
#include <memory>
#include <thread>

#include "protocol/hardened/master.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/protocol/hardened/hardened_segment.hpp"

namespace protocol::hardened {
namespace {

tl::unexpected<SharedMemoryError> error(SharedMemoryError kind) { return tl::unexpected(kind); }

TEST(Roles, are_held_by_one_at_a_time) {
  const HardenedSegment segment;
  Master first(segment.name(), impatient());
  Master second(segment.name(), impatient());
  ASSERT_TRUE(first.open());
  EXPECT_EQ(second.open(), error(SharedMemoryError::role_taken));
  EXPECT_FALSE(second.is_open());
  first.close();
  EXPECT_TRUE(second.open());
}

TEST(Roles, of_master_and_slave_are_two) {
  const HardenedSegment segment;
  Master master(segment.name(), impatient());
  Slave slave(segment.name(), impatient());
  EXPECT_TRUE(master.open());
  EXPECT_TRUE(slave.open());
  Slave second(segment.name(), impatient());
  EXPECT_EQ(second.open(), error(SharedMemoryError::role_taken));
}

/// A child process that opens a side, says so, and waits to be killed.
template <typename Opened>
class Child {
 public:
  template <typename... Arguments>
  explicit Child(const Arguments&... arguments) {
    int ready[2];
    EXPECT_EQ(::pipe(ready), 0);
    process_ = ::fork();
    if (process_ == 0) {
      Opened side(arguments...);
      const char opened = side.open() ? '1' : '0';
      static_cast<void>(::write(ready[1], &opened, 1));
      for (;;) ::pause();
    }
    char opened = 0;
    EXPECT_EQ(::read(ready[0], &opened, 1), 1);
    EXPECT_EQ(opened, '1');
    ::close(ready[0]);
    ::close(ready[1]);
  }
  void kill() {
    EXPECT_EQ(::kill(process_, SIGKILL), 0);
    EXPECT_EQ(::waitpid(process_, nullptr, 0), process_);
  }

 private:
  pid_t process_ = -1;
};

TEST(Roles, are_held_while_a_process_lives_and_free_when_it_was_killed) {
  const HardenedSegment segment;
  Child<Slave> child(segment.name(), impatient());
  Slave slave(segment.name(), impatient());
  EXPECT_EQ(slave.open(), error(SharedMemoryError::role_taken));
  child.kill();
  EXPECT_TRUE(slave.open());
}

TEST(Segment, is_removed_by_whoever_finds_nobody_else) {
  const HardenedSegment segment;
  auto master = std::make_unique<Master>(segment.name(), impatient());
  ASSERT_TRUE(master->open());
  EXPECT_EQ(remove_segment(segment.name()), error(SharedMemoryError::role_taken));
  master.reset();
  EXPECT_TRUE(remove_segment(segment.name()));
  EXPECT_LT(::shm_open(('/' + segment.name()).c_str(), O_RDWR, 0), 0);
  EXPECT_LT(::shm_open(('/' + segment.name() + ".roles").c_str(), O_RDWR, 0), 0);
  EXPECT_FALSE(Doorbell::remove(segment.name() + ".request"));
  EXPECT_FALSE(Doorbell::remove(segment.name() + ".response"));
}

TEST(Segment, is_not_removed_while_a_slave_is_attached) {
  const HardenedSegment segment;
  Slave slave(segment.name(), impatient());
  ASSERT_TRUE(slave.open());
  EXPECT_EQ(remove_segment(segment.name()), error(SharedMemoryError::role_taken));
}

TEST(Segment, for_areas_of_another_size_is_refused_and_left_as_it_is) {
  const HardenedSegment segment;
  Slave slave(segment.name(), impatient());
  ASSERT_TRUE(slave.open());
  for (const std::uint32_t bytes_max : {4, 12}) {
    Options other = impatient();
    other.request_bytes_max = bytes_max;
    Master master(segment.name(), other);
    EXPECT_EQ(master.open(), error(SharedMemoryError::other_layout));
  }
  EXPECT_EQ(RawSegment(segment.name()).size_bytes(), 108U);
  EXPECT_TRUE(Master(segment.name(), impatient()).open());
}

TEST(Segment, that_lost_its_name_while_somebody_is_attached_is_noticed) {
  const HardenedSegment segment;
  Slave slave(segment.name(), impatient());
  ASSERT_TRUE(slave.open());
  ASSERT_EQ(::shm_unlink(('/' + segment.name()).c_str()), 0);
  Master master(segment.name(), impatient());
  EXPECT_EQ(master.open(), error(SharedMemoryError::other_segment));
  slave.close();
  EXPECT_TRUE(master.open());
  EXPECT_TRUE(slave.open());
}

TEST(Segment, of_nobody_is_made_by_whoever_comes_first) {
  const HardenedSegment segment;
  Master master(segment.name(), impatient());
  ASSERT_TRUE(master.open());
  EXPECT_EQ(segment.word(), StateWord{});
  Slave slave(segment.name(), impatient());
  ASSERT_TRUE(slave.open());
  EXPECT_EQ(segment.word(), (StateWord{Phase::idle, 1, 0}));
}

TEST(Segment, is_one_when_both_sides_make_it_at_once) {
  for (int round = 0; round < 50; ++round) {
    const HardenedSegment segment;
    std::latch both_open(2);
    std::thread emulator([&] {
      Slave slave(segment.name(), impatient());
      EXPECT_TRUE(slave.open());
      both_open.arrive_and_wait();
    });
    Master master(segment.name(), impatient());
    EXPECT_TRUE(master.open());
    both_open.arrive_and_wait();
    emulator.join();
    EXPECT_EQ(segment.word().phase, Phase::down);
  }
}

TEST(Segment, cannot_be_had_under_a_name_that_is_none) {
  Master master("no/such/folder", impatient());
  EXPECT_EQ(master.open(), error(SharedMemoryError::cannot_open));
}

TEST(Roles, with_a_process_that_does_not_finish_making_the_objects_are_waited_for_only_so_long) {
  const HardenedSegment segment;
  Roles held(segment.name());
  ASSERT_TRUE(held.take(Side::slave, std::chrono::steady_clock::now()));
  Options options = impatient();
  options.open_timeout = std::chrono::milliseconds(1);
  Master master(segment.name(), options);
  EXPECT_EQ(master.open(), error(SharedMemoryError::not_made_in_time));
  held.made();
  EXPECT_TRUE(master.open());
}

}  // namespace
}  // namespace protocol::hardened
