// System V shared memory and semaphores in the simulated world.

#include <sys/ipc.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

constexpr key_t key = 0x4c54;

class SystemVTest : public FaultsTest {};

int change(int set, std::vector<sembuf> operations) {
  return semop(set, operations.data(), operations.size());
}

int change(int set, short by, short flags = 0) {
  return change(set, {{.sem_num = 0, .sem_op = by, .sem_flg = flags}});
}

int* map_word() { return static_cast<int*>(shmat(shmget(key, 4, IPC_CREAT | 0600), nullptr, 0)); }

template <typename Call>
bool fails_with(int error, const Call& call) {
  errno = 0;
  return call() == -1 && errno == error;
}

// --- shared memory ---

TEST_F(SystemVTest, two_processes_see_the_bytes_of_one_key_at_addresses_of_their_own) {
  std::array<void*, 2> places{};
  const auto attach = [&](std::size_t who) {
    places[who] = shmat(shmget(key, 100, IPC_CREAT | 0600), nullptr, 0);
    return static_cast<int*>(places[who]);
  };
  EXPECT_TRUE(run([&](World& world) {
                world.allow_data_races();  // the time orders nothing
                world.process("writer").start("main", [&] { *attach(0) = 42; });
                world.process("reader").start("main", [&] {
                  usleep(1000);
                  world.require(*attach(1) == 42, "the bytes are the same");
                });
              }).passed());
  EXPECT_NE(places[0], places[1]);
}

TEST_F(SystemVTest, a_race_on_it_is_told_with_the_key) {
  const Outcome outcome = run([](World& world) {
    for (const char* name : {"one", "other"}) {
      world.process(name).start("main", [] { ++*map_word(); });
    }
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::data_race);
  EXPECT_NE(outcome.message.find("shm-0x4c54"), std::string::npos) << outcome.message;
}

TEST_F(SystemVTest, a_segment_is_found_by_its_key_or_refused_as_the_manual_says) {
  EXPECT_TRUE(
      run_task([](World& world) {
        world.require(fails_with(ENOENT, [] { return shmget(key, 8, 0600); }), "none yet");
        world.require(fails_with(EINVAL, [] { return shmget(key, 0, IPC_CREAT); }), "no bytes");
        const int id = shmget(key, 8, IPC_CREAT | 0600);
        world.require(shmget(key, 0, 0600) == id, "found");
        world.require(fails_with(EEXIST, [] { return shmget(key, 8, IPC_CREAT | IPC_EXCL); }), "new only");
        world.require(fails_with(EINVAL, [] { return shmget(key, 9, 0600); }), "smaller than asked for");
        world.require(shmget(IPC_PRIVATE, 8, 0600) != shmget(IPC_PRIVATE, 8, 0600), "each its own");
        world.require(fails_with(EINVAL, [] { return shmctl(99, IPC_RMID, nullptr); }), "no such one");
        world.require(shmat(99, nullptr, 0) == reinterpret_cast<void*>(-1), "no such one to attach");
      }).passed());
}

TEST_F(SystemVTest, a_removed_segment_lives_until_the_last_has_detached_it) {
  EXPECT_TRUE(run_task([](World& world) {
                const int id = shmget(key, 8, IPC_CREAT | 0600);
                auto* const at = static_cast<int*>(shmat(id, nullptr, 0));
                void* const again = shmat(id, nullptr, 0);
                *at = 7;
                world.require(shmctl(id, IPC_RMID, nullptr) == 0, "removed");
                shmid_ds status{};
                world.require(shmctl(id, IPC_STAT, &status) == 0 && status.shm_nattch == 2, "two have it");
                world.require(status.shm_segsz == 8, "its size");
                const int fresh = shmget(key, 8, IPC_CREAT | 0600);
                world.require(fresh != id, "the key leads to another one");
                world.require(*static_cast<int*>(shmat(fresh, nullptr, 0)) == 0, "an empty one");
                world.require(*at == 7, "the old one is still there");
                world.require(shmdt(at) == 0 && shmdt(again) == 0, "detached");
                world.require(fails_with(EINVAL, [&] { return shmdt(at); }), "only once");
                world.require(fails_with(EINVAL, [&] { return shmctl(id, IPC_STAT, &status); }), "gone");
              }).passed());
}

TEST_F(SystemVTest, memory_that_was_detached_or_is_for_reading_only_cannot_be_written) {
  const auto crashes = [](int flags, bool detaches) {
    return run_task([=](World&) {
      auto* const at = static_cast<int*>(shmat(shmget(IPC_PRIVATE, 8, 0600), nullptr, flags));
      if (detaches) shmdt(at);
      *at = 1;
    });
  };
  EXPECT_TRUE(crashes(0, false).passed());
  EXPECT_EQ(crashes(SHM_RDONLY, false).kind, OutcomeKind::crash);
  EXPECT_EQ(crashes(0, true).kind, OutcomeKind::crash);
}

// --- semaphores ---

TEST_F(SystemVTest, a_new_set_counts_from_zero_and_takes_values) {
  EXPECT_TRUE(
      run_task([](World& world) {
        const int id = semget(key, 3, IPC_CREAT | 0600);
        world.require(semctl(id, 1, GETVAL) == 0, "nobody has set it");
        world.require(semctl(id, 1, SETVAL, 5) == 0 && semctl(id, 1, GETVAL) == 5, "set");
        std::array<unsigned short, 3> values{1, 2, 3};
        world.require(semctl(id, 0, SETALL, values.data()) == 0, "all set");
        values = {};
        world.require(semctl(id, 0, GETALL, values.data()) == 0 && values[2] == 3, "all told");
        world.require(fails_with(ERANGE, [&] { return semctl(id, 0, SETVAL, 32768); }), "too much");
        world.require(fails_with(EINVAL, [&] { return semctl(id, 3, GETVAL); }), "no such one");
        world.require(fails_with(ERANGE, [&] { return change(id, 32767); }), "too much for one");
        world.require(
            fails_with(EFBIG, [&] { return change(id, {{.sem_num = 3, .sem_op = 1, .sem_flg = 0}}); }),
            "none of this set");
        world.require(fails_with(ENOENT, [] { return semget(1, 1, 0600); }), "no such set");
        world.require(fails_with(EEXIST, [] { return semget(key, 3, IPC_CREAT | IPC_EXCL); }), "new only");
        world.require(fails_with(EINVAL, [] { return semget(key, 4, 0600); }), "it has fewer");
        world.require(semget(key, 0, 0600) == id, "found");
      }).passed());
}

TEST_F(SystemVTest, one_that_wants_more_than_there_is_waits_and_the_operations_of_a_call_are_made_together) {
  EXPECT_TRUE(run([](World& world) {
                world.process("p").start("main", [&world] {
                  const int id = semget(key, 2, IPC_CREAT | 0600);
                  std::thread taker{[&] {
                    change(id, {{.sem_num = 0, .sem_op = -1, .sem_flg = 0},
                                {.sem_num = 1, .sem_op = -2, .sem_flg = 0}});
                  }};
                  usleep(100);
                  change(id, {{.sem_num = 0, .sem_op = 1, .sem_flg = 0}});
                  usleep(100);
                  world.require(semctl(id, 0, GETVAL) == 1, "nothing was taken while it could not take all");
                  world.require(semctl(id, 1, GETNCNT) == 1 && semctl(id, 1, GETZCNT) == 0,
                                "it waits for the second");
                  change(id, {{.sem_num = 1, .sem_op = 2, .sem_flg = 0}});
                  taker.join();
                  world.require(semctl(id, 0, GETVAL) == 0 && semctl(id, 1, GETVAL) == 0, "all was taken");
                });
              }).passed());
}

TEST_F(SystemVTest, zero_can_be_waited_for) {
  EXPECT_TRUE(run_task([](World& world) {
                const int id = semget(key, 1, IPC_CREAT | 0600);
                change(id, 2);
                bool is_through = false;
                std::thread waits{[&] {
                  change(id, 0);
                  is_through = true;
                }};
                change(id, -1);
                usleep(100);
                world.require(!is_through && semctl(id, 0, GETZCNT) == 1 && semctl(id, 0, GETNCNT) == 0,
                              "it waits");
                change(id, -1);
                waits.join();
              }).passed());
}

TEST_F(SystemVTest, a_wait_ends_at_its_time_at_once_if_it_must_not_wait_and_when_the_set_is_removed) {
  EXPECT_TRUE(run_task([](World& world) {
                const int id = semget(key, 1, IPC_CREAT | 0600);
                world.require(fails_with(EAGAIN, [&] { return change(id, -1, IPC_NOWAIT); }), "at once");
                const SimTime begin = world.now();
                sembuf take{.sem_num = 0, .sem_op = -1, .sem_flg = 0};
                const timespec within{.tv_sec = 0, .tv_nsec = 1'000'000};
                world.require(fails_with(EAGAIN, [&] { return semtimedop(id, &take, 1, &within); }),
                              "time-out");
                world.require(world.now() - begin >= std::chrono::milliseconds{1}, "after its time");
                std::thread waits{[&] {
                  world.require(fails_with(EIDRM, [&] { return change(id, -1); }), "the set has gone");
                }};
                usleep(100);
                world.require(semctl(id, 0, IPC_RMID) == 0, "removed");
                waits.join();
                world.require(fails_with(EINVAL, [&] { return change(id, 1); }), "nothing there any more");
              }).passed());
}

TEST_F(SystemVTest, what_is_written_before_a_post_is_read_after_the_wait_without_a_race) {
  for (const bool waits : {true, false}) {
    const Outcome outcome = run_randomly(20, [waits](World& world) {
      for (const bool writes : {true, false}) {
        world.process(writes ? "writer" : "reader").start("main", [=] {
          const int set = semget(key, 1, IPC_CREAT | 0600);
          auto* const at = map_word();
          if (writes) *at = 1;
          if (writes) change(set, 1);
          if (!writes && waits) change(set, -1);
          if (!writes) static_cast<void>(*static_cast<volatile int*>(at));
        });
      }
    });
    EXPECT_EQ(outcome.kind, waits ? OutcomeKind::passed : OutcomeKind::data_race) << outcome.message;
  }
}

TEST_F(SystemVTest, who_takes_comes_after_who_has_given_and_not_after_who_has_taken) {
  for (const short tokens : {short{1}, short{2}}) {
    const Outcome outcome = run_randomly(50, [tokens](World& world) {
      world.process("p").start("main", [tokens] {
        const int set = semget(key, 1, IPC_CREAT | 0600);
        int* const word = map_word();
        change(set, tokens);
        const auto write = [&] {
          change(set, -1);
          *word = 1;
          change(set, 1);
        };
        std::thread other{write};
        write();
        other.join();
      });
    });
    EXPECT_EQ(outcome.kind, tokens == 1 ? OutcomeKind::passed : OutcomeKind::data_race) << outcome.message;
  }
}

TEST_F(SystemVTest, who_has_waited_for_zero_comes_after_who_has_taken_the_last) {
  for (const bool waits : {true, false}) {
    const Outcome outcome = run_randomly(50, [waits](World& world) {
      world.process("p").start("main", [waits] {
        const int set = semget(key, 1, IPC_CREAT | 0600);
        int* const word = map_word();
        change(set, 1);
        std::thread taker{[&] {
          *word = 1;
          change(set, -1);
        }};
        if (waits) change(set, 0);
        *word = 2;
        taker.join();
      });
    });
    EXPECT_EQ(outcome.kind, waits ? OutcomeKind::passed : OutcomeKind::data_race) << outcome.message;
  }
}

TEST_F(SystemVTest, who_tries_again_and_again_lets_others_come) {
  EXPECT_TRUE(run([](World& world) {
                world.process("tries").start("main", [] {
                  const int set = semget(key, 1, IPC_CREAT | 0600);
                  while (semctl(set, 0, GETVAL) == 0) continue;
                  while (change(set, -2, IPC_NOWAIT) == -1) continue;
                });
                world.process("gives").start("main", [] {
                  const int set = semget(key, 1, IPC_CREAT | 0600);
                  change(set, 1);
                  usleep(10);
                  change(set, 1);
                });
              }).passed());
  EXPECT_LT(world().scheduler().points(), 1000);  // not only when the fair tail begins
}

TEST_F(SystemVTest, two_that_wait_for_each_other_are_a_deadlock_that_names_the_set) {
  const Outcome outcome = run_task([](World&) { change(semget(key, 1, IPC_CREAT | 0600), -1); });
  EXPECT_EQ(outcome.kind, OutcomeKind::deadlock);
  EXPECT_NE(outcome.message.find("semop sem-0x4c54"), std::string::npos) << outcome.message;
}

TEST_F(SystemVTest, who_waits_goes_on_when_the_count_is_set) {
  for (const bool all : {false, true}) {
    EXPECT_TRUE(run_task([all](World& world) {
                  const int id = semget(key, 1, IPC_CREAT | 0600);
                  std::thread waits{[&] { change(id, -1); }};
                  usleep(100);
                  unsigned short values = 2;
                  if (all) semctl(id, 0, SETALL, &values);
                  if (!all) semctl(id, 0, SETVAL, 2);
                  waits.join();
                  world.require(semctl(id, 0, GETVAL) == 1, "one was taken");
                }).passed());
  }
}

TEST_F(SystemVTest, what_was_to_be_undone_is_forgotten_when_the_count_is_set) {
  EXPECT_TRUE(run_with({"crash victim/main before sleep - #1 of victim"}, [](World& world) {
                world.process("victim").may_crash({});
                world.process("victim").start("main", [] {
                  const int id = semget(key, 1, IPC_CREAT | 0600);
                  change(id, 5, SEM_UNDO);
                  semctl(id, 0, SETVAL, 7);
                  usleep(10'000);
                });
                world.process("witness").start("main", [&world] {
                  usleep(1000);
                  world.require(semctl(semget(key, 1, 0600), 0, GETVAL) == 7, "7 stays");
                });
                world.run();
              }).passed());
}

/// A process takes the one token there is and is killed with it; another one wants it. @return whether that one got it
bool survivor_gets_the_token(World& world, short flags) {
  bool got = false;
  world.process("victim").may_crash({});
  world.process("victim").start("main", [=] {
    const int id = semget(key, 1, IPC_CREAT | 0600);
    semctl(id, 0, SETVAL, 1);
    change(id, -1, flags);
    usleep(10'000);
  });
  world.process("survivor").start("main", [&got] {
    usleep(1000);
    sembuf take{.sem_num = 0, .sem_op = -1, .sem_flg = 0};
    const timespec within{.tv_sec = 1, .tv_nsec = 0};
    got = semtimedop(semget(key, 1, 0600), &take, 1, &within) == 0;
  });
  world.run();
  world.require(world.process("victim").crashes() == 1, "it was killed");
  return got;
}

TEST_F(SystemVTest, the_token_of_a_killed_process_comes_back_if_it_took_it_to_be_undone) {
  const std::vector<std::string> killed_asleep = {"crash victim/main before sleep - #1 of victim"};
  EXPECT_TRUE(run_with(killed_asleep, [](World& world) {
                world.require(survivor_gets_the_token(world, SEM_UNDO), "it came back");
              }).passed());
  EXPECT_TRUE(run_with(killed_asleep, [](World& world) {
                world.require(!survivor_gets_the_token(world, 0), "it is gone for good");
              }).passed());
}

}  // namespace
}  // namespace ltsim
