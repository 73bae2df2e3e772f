// At most one kernel and one emulator on a segment, and none after its process has died.

#include <array>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include "protocol/role_lock.hpp"
#include "tests/protocol/test_segment.hpp"

namespace protocol {
namespace {

std::string lock_path(const TestSegment& segment) { return "/tmp/ltsim-" + segment.name() + ".kernel.lock"; }

TEST(RoleLock, is_held_by_one_at_a_time) {
  const TestSegment segment;
  RoleLock first(segment.name(), Role::kernel);
  RoleLock second(segment.name(), Role::kernel);
  ASSERT_TRUE(first.try_lock());
  EXPECT_EQ(second.try_lock(), tl::make_unexpected(RoleLockError::held_by_other));
  EXPECT_FALSE(second.is_held());
  first.release();
  EXPECT_TRUE(second.try_lock());
}

TEST(RoleLock, taking_it_twice_changes_nothing) {
  const TestSegment segment;
  RoleLock lock(segment.name(), Role::kernel);
  ASSERT_TRUE(lock.try_lock());
  EXPECT_TRUE(lock.try_lock());
  EXPECT_TRUE(lock.is_held());
}

TEST(RoleLock, keeps_roles_and_segments_apart) {
  const TestSegment segment;
  const TestSegment other_segment;
  RoleLock kernel(segment.name(), Role::kernel);
  RoleLock emulator(segment.name(), Role::emulator);
  RoleLock elsewhere(other_segment.name(), Role::kernel);
  EXPECT_TRUE(kernel.try_lock());
  EXPECT_TRUE(emulator.try_lock());
  EXPECT_TRUE(elsewhere.try_lock());
}

TEST(RoleLock, can_be_seen_without_taking_it) {
  const TestSegment segment;
  RoleLock holder(segment.name(), Role::kernel);
  const RoleLock onlooker(segment.name(), Role::kernel);
  EXPECT_FALSE(onlooker.is_held_by_other());
  ASSERT_TRUE(holder.try_lock());
  EXPECT_TRUE(onlooker.is_held_by_other());
  EXPECT_FALSE(holder.is_held_by_other());
  holder.release();
  EXPECT_FALSE(onlooker.is_held_by_other());
}

TEST(RoleLock, leaves_no_file_behind) {
  const TestSegment segment;
  {
    RoleLock lock(segment.name(), Role::kernel);
    ASSERT_TRUE(lock.try_lock());
    EXPECT_EQ(::access(lock_path(segment).c_str(), F_OK), 0);
  }
  EXPECT_NE(::access(lock_path(segment).c_str(), F_OK), 0);
}

TEST(RoleLock, is_never_held_twice_by_those_who_take_and_release_it_all_the_time) {
  // Whoever opened the lock file before its holder removed it must not take the lock of a file without a
  // name.
  const TestSegment segment;
  std::atomic<int> holders_count = 0;
  std::atomic<bool> held_twice = false;
  const auto take_and_release = [&] {
    RoleLock lock(segment.name(), Role::kernel);
    for (int round = 0; round < 5000; ++round) {
      if (!lock.try_lock()) continue;
      if (++holders_count > 1) held_twice = true;
      std::this_thread::yield();
      --holders_count;
      lock.release();
    }
  };
  {
    const std::jthread first(take_and_release);
    const std::jthread second(take_and_release);
  }
  EXPECT_FALSE(held_twice);
}

TEST(RoleLock, a_segment_name_with_a_slash_stays_within_the_folder) {
  RoleLock lock("protocol-test/../../etc", Role::kernel);
  EXPECT_TRUE(lock.try_lock());
  EXPECT_EQ(::access("/tmp/ltsim-protocol-test_.._.._etc.kernel.lock", F_OK), 0);
}

TEST(RoleLock, is_free_after_its_process_was_killed) {
  const TestSegment segment;
  std::array<int, 2> locked{};
  ASSERT_EQ(::pipe(locked.data()), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    RoleLock lock(segment.name(), Role::kernel);
    const char answer = lock.try_lock() ? 'y' : 'n';
    if (::write(locked[1], &answer, 1) == 1) ::pause();
    ::_exit(0);
  }
  char answer = 0;
  ASSERT_EQ(::read(locked[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  RoleLock lock(segment.name(), Role::kernel);
  EXPECT_TRUE(lock.is_held_by_other());
  EXPECT_EQ(lock.try_lock(), tl::make_unexpected(RoleLockError::held_by_other));

  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_FALSE(lock.is_held_by_other());
  EXPECT_TRUE(lock.try_lock());
  ::close(locked[0]);
  ::close(locked[1]);
}

}  // namespace
}  // namespace protocol
