// Shared memory that changes without an access that the world sees: a pass would mean nothing, and so it is
// said.

#include <pthread.h>

#include <cstring>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"
#include "tests/sim_clock/races_fixture.hpp"

namespace ltsim {
namespace {

class MemoryWatchTest : public RacesTest {
 protected:
  /// As code does that no compiler has instrumented.
  static void write_unseen(unsigned char& byte) { asm volatile("movb $7, %0" : "=m"(byte)); }
  static bool is_accused(const Outcome& outcome, const char* byte) {
    return outcome.kind == OutcomeKind::unsupported &&
           outcome.message.starts_with(std::string{"byte "} + byte +
                                       " of segment segment changed without an access that ltsim saw");
  }
};

TEST_F(MemoryWatchTest, an_unseen_store_is_noticed_at_the_next_access) {
  const Outcome outcome = run_alone([](Memory& m) {
    write_unseen(m.bytes[8]);
    read(m.bytes[8]);
  });
  EXPECT_TRUE(is_accused(outcome, "12")) << outcome.message;
  EXPECT_NE(outcome.message.find("a/main noticed it"), std::string::npos) << outcome.message;
}

TEST_F(MemoryWatchTest, an_unseen_store_is_noticed_at_the_end_if_nobody_looks) {
  const Outcome outcome = run_alone([](Memory& m) { write_unseen(m.bytes[8]); });
  EXPECT_TRUE(is_accused(outcome, "12")) << outcome.message;
  EXPECT_NE(outcome.message.find("at the end"), std::string::npos) << outcome.message;
}

TEST_F(MemoryWatchTest, an_unseen_store_beside_a_seen_one_is_noticed) {
  const Outcome outcome = run_alone([](Memory& m) {
    write(m.bytes[9]);
    write_unseen(m.bytes[8]);
  });
  EXPECT_TRUE(is_accused(outcome, "12")) << outcome.message;
}

TEST_F(MemoryWatchTest, an_unseen_store_is_noticed_through_another_mapping) {
  const Outcome outcome =
      run_in_turn({[](Memory& m) { write_unseen(m.bytes[8]); }, [](Memory& m) { read(m.bytes[8]); }});
  EXPECT_TRUE(is_accused(outcome, "12")) << outcome.message;
  EXPECT_NE(outcome.message.find("b/main noticed it"), std::string::npos) << outcome.message;
}

TEST_F(MemoryWatchTest, every_kind_of_seen_write_is_taken_over) {
  struct Large {
    std::array<unsigned char, 40> bytes;
  };
  const Outcome outcome = run_alone([](Memory& m) {
    write(m.bytes[0]);
    write(reinterpret_cast<int&>(m.bytes[6]));  // across eight bytes
    std::memset(&m.bytes[3], 5, 19);
    std::memmove(&m.bytes[4], &m.bytes[3], 19);
    m.flag.store(3);
    m.flag.fetch_add(2);
    int expected = 5;
    m.flag.compare_exchange_strong(expected, 9);
    m.flag.compare_exchange_strong(expected, 10);
    static Large source;
    source.bytes.fill(6);
    *reinterpret_cast<Large*>(&m) = source;  // announced as a whole
    for (const unsigned char& byte : m.bytes) read(byte);
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(MemoryWatchTest, memory_that_grows_again_is_zero_and_nobody_is_accused) {
  const Outcome outcome = run_alone([](Memory& m) {
    write(m.value);
    const int descriptor = shm_open("/segment", O_RDWR, 0600);
    EXPECT_EQ(ftruncate(descriptor, 0), 0);
    EXPECT_EQ(ftruncate(descriptor, 4096), 0);
    read(m.value);
    EXPECT_EQ(seen, 0);
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(MemoryWatchTest, locks_in_a_segment_are_the_worlds_own) {
  struct Locks {
    pthread_mutex_t mutex;
    pthread_cond_t condition;
    sem_t semaphore;
    pthread_mutex_t never_locked;
  };
  const Outcome outcome = run_alone([](Memory& m) {
    auto& locks = reinterpret_cast<Locks&>(m);
    pthread_mutex_init(&locks.mutex, nullptr);
    pthread_cond_init(&locks.condition, nullptr);
    pthread_mutexattr_t recursive;
    pthread_mutexattr_init(&recursive);
    pthread_mutexattr_settype(&recursive, PTHREAD_MUTEX_RECURSIVE);
    pthread_mutex_init(&locks.never_locked, &recursive);
    sem_init(&locks.semaphore, 1, 1);
    pthread_mutex_lock(&locks.mutex);
    EXPECT_NE(pthread_mutex_trylock(&locks.mutex), 0);
    pthread_cond_signal(&locks.condition);
    const timespec deadline = in(1ms, CLOCK_REALTIME);
    pthread_cond_timedwait(&locks.condition, &locks.mutex, &deadline);
    pthread_mutex_unlock(&locks.mutex);
    sem_wait(&locks.semaphore);
    sem_destroy(&locks.semaphore);
    pthread_mutex_destroy(&locks.mutex);
    read(reinterpret_cast<int&>(locks.mutex));
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(MemoryWatchTest, a_change_on_purpose_is_accepted) {
  const Outcome outcome = run_alone([](Memory& m) {
    write_unseen(m.bytes[8]);
    world().segments().accept_change(&m.bytes[8], 1);
    read(m.bytes[8]);
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(MemoryWatchTest, an_exploration_with_an_unseen_change_ends_as_not_simulable) {
  const Scenario scenario{.name = "test/unseen", .description = "", .body = [](World& world) {
                            world.process("a").start(
                                "main", [] { write_unseen(static_cast<Memory*>(map_segment())->bytes[8]); });
                            world.run();
                          }};
  RandomStrategy strategy;
  ExploreOptions options;
  options.executions_max = 10;
  EXPECT_THROW(static_cast<void>(Explorer{world()}.explore(scenario, strategy, options)),
               Explorer::NotSimulable);
}

}  // namespace
}  // namespace ltsim
