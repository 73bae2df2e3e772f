// Crashes: a process is killed where it stands and may be started again.

#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

struct Shared {
  std::atomic<int> steps;
  pthread_mutex_t mutex;
};

class CrashTest : public FaultsTest {
 protected:
  /// @param crashes  each "ANCHOR of PROCESS"
  static Outcome run_crashing(std::vector<std::string> crashes, void (*body)(World&)) {
    for (std::string& crash : crashes) crash.insert(0, "crash ");
    return run_with(crashes, body);
  }

  /// A segment of one page, made anew or found, mapped for the process that calls.
  static Shared& map_shared() { return *static_cast<Shared*>(map_segment()); }

  /// Two processes increment a counter under a robust mutex; each may crash.
  static void count_under_a_robust_mutex(World& world);
};

void init_mutex(pthread_mutex_t& mutex, int robustness) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, robustness);
  pthread_mutex_init(&mutex, &attributes);
}

int destroyed_count = 0;
struct CountsItsEnd {
  bool touched = false;
  ~CountsItsEnd() { ++destroyed_count; }
};
thread_local CountsItsEnd of_thread;

timespec soon() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  time.tv_sec += 1;
  return time;
}

// --- what stops, and what stays ---

TEST_F(CrashTest, a_killed_process_stops_where_it_stands_and_shared_memory_stays_as_it_was) {
  EXPECT_EQ(run_crashing({"victim/main before atomic_update segment #3 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [] {
                             auto& shared = map_shared();
                             for (int i = 0; i < 5; ++i) ++shared.steps;
                           });
                           world.process("witness").start("main", [&world] {
                             usleep(1000);
                             world.require(map_shared().steps == 2, "two steps were made");
                           });
                           world.run();
                           world.require(world.process("victim").crashes() == 1, "one crash");
                           world.require(!world.process("victim").is_running(), "it is dead");
                         }),
            Outcome{});
}

TEST_F(CrashTest, nothing_of_a_killed_task_is_unwound_or_destroyed) {
  destroyed_count = 0;
  EXPECT_EQ(run_crashing({"victim/main before clock_read - #1 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [] {
                             of_thread.touched = true;
                             const CountsItsEnd on_stack;
                             static_cast<void>(time(nullptr));
                           });
                           world.run();
                         }),
            Outcome{});
  EXPECT_EQ(destroyed_count, 0);
}

TEST_F(CrashTest, the_only_task_that_can_run_may_be_killed_and_sleepers_go_on) {
  EXPECT_EQ(run_crashing({"victim/main before yield - #1 of victim"},
                         [](World& world) {
                           bool woke = false;
                           world.process("victim").may_crash({});
                           world.process("sleeper").start("main", [&woke] {
                             usleep(1000);
                             woke = true;
                           });
                           world.process("victim").start("main", [] { std::this_thread::yield(); });
                           world.run();
                           world.require(woke && world.now() >= 1ms, "the sleeper woke");
                         }),
            Outcome{});
}

TEST_F(CrashTest, the_only_task_of_all_may_be_killed) {
  EXPECT_EQ(run_crashing({"victim/main before yield - #1 of victim"},
                         [](World& world) {
                           bool went_on = false;
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [&went_on] {
                             std::this_thread::yield();
                             went_on = true;
                           });
                           world.run();
                           world.require(!went_on, "nothing of it runs");
                         }),
            Outcome{});
}

TEST_F(CrashTest, a_process_dies_with_all_its_threads_at_a_step_of_another) {
  EXPECT_EQ(run_crashing({"killer/main before yield - #1 of victim"},
                         [](World& world) {
                           int went_on = 0;
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [&went_on] {
                             std::thread runs{[&went_on] {
                               usleep(3000);
                               ++went_on;
                             }};
                             std::thread waits{[&went_on] {
                               sem_wait(sem_open("/never", O_CREAT, 0600, 0U));
                               ++went_on;
                             }};
                             runs.join();
                             waits.join();
                             ++went_on;
                           });
                           world.process("killer").start("main", [] {
                             usleep(1000);
                             std::this_thread::yield();
                           });
                           world.run();
                           world.require(went_on == 0, "nobody of it goes on");
                           world.require(world.now() < 3ms, "its timers are disarmed");
                         }),
            Outcome{});
}

TEST_F(CrashTest, a_post_for_a_process_that_was_killed_in_its_wait_stays_in_the_semaphore) {
  EXPECT_EQ(run_crashing({"poster/main before sem_post s #1 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main",
                                                         [] { sem_wait(sem_open("/s", O_CREAT, 0600, 0U)); });
                           world.process("poster").start("main", [&world] {
                             usleep(1000);
                             world.require(world.blocked_in("victim/main") == "sem_wait s", "it waits");
                             sem_t* const semaphore = sem_open("/s", O_CREAT, 0600, 0U);
                             sem_post(semaphore);
                             int value = 0;
                             sem_getvalue(semaphore, &value);
                             world.require(value == 1, "the post is there");
                             world.require(world.blocked_in("victim/main").empty(), "the dead do not wait");
                           });
                           world.run();
                         }),
            Outcome{});
}

TEST_F(CrashTest, its_mappings_and_descriptors_are_gone_and_do_not_add_up_over_its_lives) {
  // A process can hold Segments::mappings_max mappings of a segment: each life needs them all.
  EXPECT_EQ(run_crashing(
                {"victim/main before yield - #1 of victim", "victim@2/main before yield - #1 of victim"},
                [](World& world) {
                  Process& victim = world.process("victim");
                  victim.may_crash({.times = 2, .restart_after = 1ms});
                  victim.start("main", [&victim, &world] {
                    for (std::size_t i = 0; i < Segments::mappings_max; ++i)
                      world.require(map_segment() != MAP_FAILED, "mapped");
                    struct stat status{};
                    const unsigned victim_lives = victim.incarnation();
                    world.require(fstat(Segments::first_descriptor, &status) == (victim_lives == 1 ? 0 : -1),
                                  "a descriptor of an earlier life is closed");
                    std::this_thread::yield();
                  });
                  world.run();
                  world.require(victim.incarnation() == 3, "three lives");
                }),
            Outcome{});
}

// --- starting again ---

TEST_F(CrashTest, a_process_starts_again_so_much_later_under_another_name_and_number) {
  EXPECT_EQ(
      run_crashing({"victim/main before yield - #1 of victim"},
                   [](World& world) {
                     Process& victim = world.process("victim");
                     std::vector<SimTime> begins;
                     std::vector<pid_t> pids;
                     victim.may_crash({.times = 1, .restart_after = 5ms});
                     victim.start("main", [&] {
                       begins.push_back(world.now());
                       pids.push_back(getpid());
                       std::thread{[] { usleep(10); }}.join();
                       if (victim.incarnation() == 1) std::this_thread::yield();

                       sem_wait(sem_open("/s", O_CREAT, 0600, 0U));
                     });
                     world.process("witness").start("main", [&world, &victim] {
                       usleep(1000);
                       world.require(!victim.is_running() && victim.incarnation() == 2, "down");
                       world.require(world.blocked_in("victim/main").empty(), "not yet in its new life");
                       usleep(10000);
                       world.require(victim.is_running(), "up again");
                       world.require(world.blocked_in("victim/main") == "sem_wait s", "latest life");
                       world.require(world.blocked_in("victim@2/main") == "sem_wait s", "by full name");
                       sem_post(sem_open("/s", O_CREAT, 0600, 0U));
                     });
                     world.run();
                     world.require(begins.size() == 2 && pids[0] != pids[1], "two lives");
                     const auto last = static_cast<TaskId>(world.scheduler().tasks_count() - 1);
                     world.require(world.scheduler().task(last).name == "victim@2/thread-1",
                                   "threads count anew");
                     world.require(
                         begins.back() - begins.front() >= 5ms && begins.back() - begins.front() < 5ms + 20us,
                         "5 ms later");
                   }),
      Outcome{});
}

TEST_F(CrashTest, without_a_restart_the_peer_waits_for_ever) {
  const Outcome outcome = run_crashing({"poster/main before sem_post s #1 of poster"}, [](World& world) {
    world.process("waiter").start("main", [] { sem_wait(sem_open("/s", O_CREAT, 0600, 0U)); });
    world.process("poster").may_crash({});
    world.process("poster").start("main", [] { sem_post(sem_open("/s", O_CREAT, 0600, 0U)); });
    world.run();
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::deadlock);
  EXPECT_NE(outcome.message.find("waiter/main"), std::string::npos) << outcome.message;
  EXPECT_EQ(outcome.message.find("poster/main"), std::string::npos) << outcome.message;
}

TEST_F(CrashTest, a_process_may_be_killed_before_its_first_step) {
  EXPECT_EQ(run_crashing({"killer/main before yield - #1 of victim"},
                         [](World& world) {
                           int lives = 0;
                           world.process("killer").start("main", [] { std::this_thread::yield(); });
                           world.process("victim").may_crash({.times = 1, .restart_after = 0ms});
                           world.process("victim").start("main", [&lives] { ++lives; });
                           world.run();
                           world.require(lives == 1, "only the second one ran");
                         }),
            Outcome{});
}

TEST_F(CrashTest, a_process_that_has_ended_or_waits_for_its_restart_cannot_be_killed) {
  for (const char* const step : {"#1", "#2"}) {
    const auto schedule = parse_schedule(std::string{"ltsim schedule 1\nscenario test/crash\n"
                                                     "crash brief/main before yield - #1 of brief\n"
                                                     "crash killer/main before clock_read - "} +
                                         step + " of brief\n");
    ASSERT_TRUE(schedule) << schedule.error().reason;
    const Scenario scenario{"test/crash", "", [](World& world) {
                              world.process("brief").may_crash({.times = 3, .restart_after = 2ms});
                              world.process("brief").start("main", [] { std::this_thread::yield(); });
                              world.process("killer").start("main", [] {
                                usleep(1000);
                                static_cast<void>(time(nullptr));  // brief is down
                                usleep(5000);
                                static_cast<void>(time(nullptr));  // brief has ended
                              });
                              world.run();
                            }};
    const ReplayReport report = Explorer{world()}.replay(scenario, *schedule, nullptr);
    EXPECT_EQ(report.outcome, Outcome{});
    ASSERT_TRUE(report.divergence) << step;
    EXPECT_EQ(report.divergence->deviation, &schedule->deviations[1]);
  }
}

TEST_F(CrashTest, a_process_is_killed_no_more_often_than_granted) {
  const Schedule schedule = schedule_of({"crash victim/main before yield - #1 of victim",
                                         "crash victim@2/main before yield - #1 of victim",
                                         "crash victim@3/main before yield - #1 of victim"});
  const ReplayReport report = replay(schedule, [](World& world) {
    world.process("victim").may_crash({.times = 2, .restart_after = 1ms});
    world.process("victim").start("main", [] { std::this_thread::yield(); });
    world.process("other").may_crash({.times = 1, .restart_after = 1ms});
    world.process("other").start("main", [] { usleep(10'000); });
    world.run();
  });
  EXPECT_EQ(report.outcome, Outcome{});
  ASSERT_TRUE(report.divergence);
  EXPECT_EQ(report.divergence->deviation, &schedule.deviations[2]);
}

// --- locks ---

TEST_F(CrashTest, an_ordinary_mutex_stays_locked_for_ever) {
  EXPECT_EQ(run_crashing({"victim/main before yield - #1 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [] {
                             auto& shared = map_shared();
                             init_mutex(shared.mutex, PTHREAD_MUTEX_STALLED);
                             pthread_mutex_lock(&shared.mutex);
                             std::this_thread::yield();
                             pthread_mutex_unlock(&shared.mutex);
                           });
                           world.process("peer").start("main", [&world] {
                             usleep(1000);
                             auto& shared = map_shared();
                             const timespec deadline = soon();
                             world.require(pthread_mutex_timedlock(&shared.mutex, &deadline) == ETIMEDOUT,
                                           "nobody unlocks it");
                           });
                           world.run();
                         }),
            Outcome{});
}

TEST_F(CrashTest, who_waits_for_ever_for_the_lock_of_the_dead_is_told_so) {
  const Outcome outcome = run_crashing({"victim/main before yield - #1 of victim"}, [](World& world) {
    world.process("victim").may_crash({});
    world.process("victim").start("main", [] {
      auto& shared = map_shared();
      init_mutex(shared.mutex, PTHREAD_MUTEX_STALLED);
      pthread_mutex_lock(&shared.mutex);
      std::this_thread::yield();
    });
    world.process("peer").start("main", [] {
      usleep(1000);
      pthread_mutex_lock(&map_shared().mutex);
    });
    world.run();
  });
  EXPECT_EQ(outcome,
            (Outcome{OutcomeKind::deadlock,
                     "peer/main waits in mutex_lock mutex-1, held by victim/main, which was killed"}));
}

TEST_F(CrashTest, the_next_owner_of_a_robust_mutex_is_told_that_the_last_one_died) {
  EXPECT_EQ(run_crashing({"victim/main before yield - #1 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [] {
                             auto& shared = map_shared();
                             init_mutex(shared.mutex, PTHREAD_MUTEX_ROBUST);
                             pthread_mutex_lock(&shared.mutex);
                             std::this_thread::yield();
                           });
                           world.process("peer").start("main", [&world] {
                             usleep(1000);
                             auto& shared = map_shared();
                             world.require(pthread_mutex_consistent(&shared.mutex) == EINVAL, "not held yet");
                             world.require(pthread_mutex_lock(&shared.mutex) == EOWNERDEAD, "told");
                             world.require(pthread_mutex_consistent(&shared.mutex) == 0, "mended");
                             world.require(pthread_mutex_unlock(&shared.mutex) == 0, "unlocked");
                             world.require(pthread_mutex_trylock(&shared.mutex) == 0, "as good as new");
                             pthread_mutex_unlock(&shared.mutex);
                           });
                           world.run();
                         }),
            Outcome{});
}

TEST_F(CrashTest, who_waits_for_a_robust_mutex_is_woken_by_the_death_of_its_owner) {
  EXPECT_EQ(run_crashing({"victim/main before clock_read - #1 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [] {
                             auto& shared = map_shared();
                             init_mutex(shared.mutex, PTHREAD_MUTEX_ROBUST);
                             pthread_mutex_lock(&shared.mutex);
                             usleep(2000);
                             static_cast<void>(time(nullptr));
                           });
                           world.process("peer").start("main", [&world] {
                             usleep(1000);
                             auto& shared = map_shared();
                             world.require(pthread_mutex_lock(&shared.mutex) == EOWNERDEAD, "told");
                             pthread_mutex_consistent(&shared.mutex);
                             pthread_mutex_unlock(&shared.mutex);
                           });
                           world.run();
                         }),
            Outcome{});
}

TEST_F(CrashTest, a_robust_mutex_that_nobody_mends_is_lost_to_all) {
  EXPECT_EQ(run_crashing({"victim/main before yield - #1 of victim"},
                         [](World& world) {
                           world.process("victim").may_crash({});
                           world.process("victim").start("main", [] {
                             auto& shared = map_shared();
                             init_mutex(shared.mutex, PTHREAD_MUTEX_ROBUST);
                             pthread_mutex_lock(&shared.mutex);
                             std::this_thread::yield();
                           });
                           world.process("careless").start("main", [&world] {
                             usleep(1000);
                             auto& shared = map_shared();
                             world.require(pthread_mutex_lock(&shared.mutex) == EOWNERDEAD, "told");
                             usleep(2000);
                             pthread_mutex_unlock(&shared.mutex);
                             world.require(pthread_mutex_trylock(&shared.mutex) == ENOTRECOVERABLE, "lost");
                           });
                           for (const char* const name : {"one", "two"}) {
                             world.process("waiters").start(name, [&world] {
                               usleep(2000);
                               auto& shared = map_shared();
                               world.require(pthread_mutex_lock(&shared.mutex) == ENOTRECOVERABLE, "woken");
                             });
                           }
                           world.run();
                         }),
            Outcome{});
}

TEST_F(CrashTest, a_robust_mutex_is_handed_on_when_its_owner_merely_ends) {
  EXPECT_EQ(run_task([](World& world) {
              pthread_mutex_t mutex;
              init_mutex(mutex, PTHREAD_MUTEX_ROBUST);
              std::thread{[&mutex] { pthread_mutex_lock(&mutex); }}.join();
              world.require(pthread_mutex_lock(&mutex) == EOWNERDEAD, "told");
              pthread_mutex_consistent(&mutex);
              pthread_mutex_unlock(&mutex);
            }),
            Outcome{});
}

// --- as a choice ---

void CrashTest::count_under_a_robust_mutex(World& world) {
  world.process("setter").start("main", [] {
    init_mutex(map_shared().mutex, PTHREAD_MUTEX_ROBUST);
    sem_t* const ready = sem_open("/ready", O_CREAT, 0600, 0U);
    for (int i = 0; i < 4; ++i) sem_post(ready);
  });
  for (const char* const name : {"one", "two"}) {
    Process& process = world.process(name);
    process.may_crash({.times = 1, .restart_after = 1ms});
    process.start("main", [&world] {
      sem_t* const ready = sem_open("/ready", O_CREAT, 0600, 0U);
      sem_wait(ready);
      auto& shared = map_shared();
      const int locked = pthread_mutex_lock(&shared.mutex);
      if (locked == EOWNERDEAD) pthread_mutex_consistent(&shared.mutex);
      world.require(locked == 0 || locked == EOWNERDEAD, "locked");
      std::thread{[&shared] { ++shared.steps; }}.join();
      pthread_mutex_unlock(&shared.mutex);
    });
  }
  world.run();
}

TEST_F(CrashTest, equal_seeds_crash_alike_and_every_recorded_execution_replays) {
  unsigned crashes = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const Failure recorded = record_and_replay(seed, &count_under_a_robust_mutex);
    ASSERT_EQ(recorded.outcome, Outcome{}) << seed;
    const unsigned of_this = world().process("one").crashes() + world().process("two").crashes();
    ASSERT_LE(of_this, 2U) << seed;
    crashes += of_this;
  }
  EXPECT_GT(crashes, 50U);
}

TEST_F(CrashTest, a_process_to_which_no_crash_is_granted_is_not_asked_for) {
  NeverStrikes strategy;
  EXPECT_EQ(run_under(strategy, 1,
                      [](World& world) {
                        for (const char* const name : {"one", "two"})
                          world.process(name).start("main", [] { ++map_shared().steps; });
                      }),
            Outcome{});
}

}  // namespace
}  // namespace ltsim
