// Faults other than crashes: what each does to the call that it strikes.

#include <linux/futex.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/syscall.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

int value_of(sem_t* semaphore) {
  int value = -1;
  sem_getvalue(semaphore, &value);
  return value;
}

bool is_about(SimTime measured, SimTime expected) {
  return measured >= expected - 20us && measured <= expected + 20us;
}

// --- semaphores ---

TEST_F(FaultsTest, a_lost_post_reports_success_and_posts_nothing) {
  EXPECT_EQ(run_with({"fault p/main before sem_post s #1 lost-post 1"},
                     [](World& world) {
                       world.grant(FaultKind::lost_post, 1);
                       world.process("p").start("main", [&world] {
                         sem_t* const semaphore = open_semaphore();
                         world.require(sem_post(semaphore) == 0 && value_of(semaphore) == 0, "lost");
                         world.require(sem_post(semaphore) == 0 && value_of(semaphore) == 1, "not lost");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, a_doubled_post_counts_twice_and_wakes_two) {
  EXPECT_EQ(run_with({"fault poster/main before sem_post s #1 doubled-post 1"},
                     [](World& world) {
                       int woken = 0;
                       world.grant(FaultKind::doubled_post, 1);
                       for (const char* const name : {"one", "two"}) {
                         world.process("waiters").start(name, [&woken] {
                           sem_wait(open_semaphore());
                           ++woken;
                         });
                       }
                       world.process("poster").start("main", [] {
                         usleep(1000);
                         sem_post(open_semaphore());
                       });
                       world.run();
                       world.require(woken == 2, "both woke");
                     }),
            Outcome{});
}

TEST_F(FaultsTest, a_fault_strikes_no_more_often_than_granted) {
  const Schedule schedule = schedule_of({"fault p/main before sem_post s #1 lost-post 1",
                                         "fault p/main before sem_post s #2 lost-post 1",
                                         "fault p/main before sem_post s #3 lost-post 1"});
  const ReplayReport report = replay(schedule, [](World& world) {
    world.grant(FaultKind::lost_post, 2);
    world.process("p").start("main", [&world] {
      sem_t* const semaphore = open_semaphore();
      for (int i = 0; i < 3; ++i) sem_post(semaphore);
      world.require(value_of(semaphore) == 1, "two were lost");
    });
    world.run();
  });
  EXPECT_EQ(report.outcome, Outcome{});
  ASSERT_TRUE(report.divergence);
  EXPECT_EQ(report.divergence->deviation, &schedule.deviations[2]);
}

TEST_F(FaultsTest, a_fault_is_anchored_to_the_step_it_strikes_also_where_others_ran_before_that_step) {
  EXPECT_EQ(run_with({"switch p/main before sem_post s #1 to p/other",
                      "fault p/main before sem_post s #1 lost-post 1"},
                     [](World& world) {
                       world.grant(FaultKind::lost_post, 1);
                       world.process("p").start("main", [] { sem_post(open_semaphore()); });
                       world.process("p").start("other", [] { std::this_thread::yield(); });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, waiting_for_a_semaphore_is_interrupted_only_where_it_would_block) {
  EXPECT_EQ(run_with({"fault p/main before sem_wait s #2 interrupt 1",
                      "fault p/main before sem_timedwait s #1 interrupt 1"},
                     [](World& world) {
                       world.grant(FaultKind::interrupt, 2);
                       world.process("p").start("main", [&world] {
                         sem_t* const semaphore = open_semaphore();
                         sem_post(semaphore);
                         world.require(sem_wait(semaphore) == 0, "the token is there");
                         world.require(sem_wait(semaphore) == -1 && errno == EINTR, "sem_wait");
                         const timespec deadline = in(1s, CLOCK_REALTIME);
                         world.require(sem_timedwait(semaphore, &deadline) == -1 && errno == EINTR,
                                       "sem_timedwait");
                         world.require(world.now() < 1ms, "at once");
                       });
                       world.run();
                     }),
            Outcome{});
}

// --- sleeping ---

TEST_F(FaultsTest, an_interrupted_sleep_says_how_much_is_left) {
  EXPECT_EQ(
      run_with({"fault p/main before sleep - #1 interrupt 1", "fault p/main before sleep - #2 interrupt 2",
                "fault p/main before sleep - #3 interrupt 2"},
               [](World& world) {
                 world.grant(FaultKind::interrupt, 3);
                 world.process("p").start("main", [&world] {
                   const timespec two_seconds{.tv_sec = 2, .tv_nsec = 0};
                   timespec left{};
                   world.require(nanosleep(&two_seconds, &left) == -1 && errno == EINTR, "nanosleep");
                   world.require(is_about(to_time(left), 2s) && world.now() < 1ms, "at once");
                   world.require(nanosleep(&two_seconds, &left) == -1, "half-way");
                   world.require(is_about(to_time(left), 1s) && is_about(world.now(), 1s), "a second");
                   left = {};
                   world.require(clock_nanosleep(CLOCK_MONOTONIC, 0, &two_seconds, &left) == EINTR,
                                 "clock_nanosleep returns the error");
                   world.require(is_about(to_time(left), 1s) && is_about(world.now(), 2s), "another second");
                 });
                 world.run();
               }),
      Outcome{});
}

TEST_F(FaultsTest, an_interrupted_sleep_until_an_absolute_time_leaves_what_is_left_alone) {
  EXPECT_EQ(run_with({"fault p/main before sleep - #1 interrupt 2"},
                     [](World& world) {
                       world.grant(FaultKind::interrupt, 1);
                       world.process("p").start("main", [&world] {
                         const timespec deadline{.tv_sec = 2, .tv_nsec = 0};
                         timespec left{.tv_sec = 77, .tv_nsec = 0};
                         world.require(
                             clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, &left) == EINTR,
                             "interrupted");
                         world.require(left.tv_sec == 77 && is_about(world.now(), 1s), "untouched");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, the_older_ways_to_sleep_are_interrupted_too_and_the_standard_library_sleeps_on) {
  EXPECT_EQ(
      run_with({"fault p/main before sleep - #1 interrupt 1", "fault p/main before sleep - #2 interrupt 2",
                "fault p/main before sleep - #3 interrupt 2"},
               [](World& world) {
                 world.grant(FaultKind::interrupt, 3);
                 world.process("p").start("main", [&world] {
                   world.require(usleep(1000) == -1 && errno == EINTR, "usleep");
                   world.require(sleep(11) == 5, "sleep says how much is left, in whole seconds");
                   const SimTime begin = world.now();
                   std::this_thread::sleep_for(2s);
                   world.require(took(world, begin, 2s), "the whole time");
                 });
                 world.run();
               }),
      Outcome{});
}

// --- waking for nothing ---

TEST_F(FaultsTest, a_wait_for_a_condition_wakes_for_nothing_with_its_mutex_held) {
  EXPECT_EQ(run_with({"fault p/main before cond_wait mutex-1 #1 spurious-wake 1",
                      "fault p/main before cond_timedwait mutex-1 #1 spurious-wake 1"},
                     [](World& world) {
                       std::mutex mutex;
                       std::condition_variable condition;
                       world.grant(FaultKind::spurious_wake, 2);
                       world.process("p").start("main", [&] {
                         std::unique_lock lock{mutex};
                         condition.wait(lock);
                         world.require(!another_could_lock(mutex), "held again");
                         const timespec deadline = in(1s, CLOCK_REALTIME);
                         world.require(pthread_cond_timedwait(condition.native_handle(),
                                                              mutex.native_handle(), &deadline) == 0,
                                       "and this is no time-out");
                         world.require(world.now() < 1ms, "at once");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, others_may_run_before_a_waiter_that_wakes_for_nothing) {
  EXPECT_EQ(run_with({"fault p/main before cond_wait mutex-1 #1 spurious-wake 1",
                      "switch p/main in cond_wait mutex-1 #1 to p/other"},
                     [](World& world) {
                       std::mutex mutex;
                       std::condition_variable condition;
                       bool other_ran = false;
                       world.grant(FaultKind::spurious_wake, 1);
                       world.process("p").start("main", [&] {
                         std::unique_lock lock{mutex};
                         condition.wait(lock);
                         world.require(other_ran, "the other one ran first");
                       });
                       world.process("p").start("other", [&] {
                         const std::lock_guard lock{mutex};
                         other_ran = true;
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, a_futex_wait_wakes_for_nothing_and_atomic_wait_is_not_fooled) {
  EXPECT_EQ(run_with({"fault p/main before futex_wait - #1 spurious-wake 1",
                      "fault p/main before futex_wait - #2 spurious-wake 1"},
                     [](World& world) {
                       std::atomic<int> word{0};
                       world.grant(FaultKind::spurious_wake, 2);
                       world.process("p").start("main", [&] {
                         world.require(syscall(SYS_futex, &word, FUTEX_WAIT, 0, nullptr) == 0, "woken");
                         word.wait(0);
                         world.require(word == 1, "it really changed");
                       });
                       world.process("p").start("other", [&] {
                         usleep(1000);
                         word = 1;
                         word.notify_one();
                       });
                       world.run();
                     }),
            Outcome{});
}

// --- damage in a segment ---

using Bytes = std::array<std::atomic<unsigned char>, 16>;

TEST_F(FaultsTest, a_bit_flips_before_an_access_to_its_segment) {
  // Bit 3 of the second granted byte, at an access to another one.
  EXPECT_EQ(run_with({"fault p/main before atomic_load segment #2 bit-flip 12"},
                     [](World& world) {
                       world.grant_in(FaultKind::bit_flip, "segment", 4, 2, 1);
                       world.process("p").start("main", [&world] {
                         auto& bytes = *static_cast<Bytes*>(map_segment());
                         world.require(bytes[5] == 0x00, "as it was");
                         static_cast<void>(bytes[0].load());
                         world.require(bytes[5] == 0x08, "flipped");
                         world.require(bytes[4] == 0x00 && bytes[6] == 0x00, "and no other");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, a_foreign_write_leaves_zeroes_ones_or_one_more) {
  EXPECT_EQ(run_with({"fault p/main before atomic_load segment #1 foreign-write 4",
                      "fault p/main before atomic_load segment #2 foreign-write 5",
                      "fault p/main before atomic_load segment #3 foreign-write 6"},
                     [](World& world) {
                       world.grant_in(FaultKind::foreign_write, "segment", 0, 1, 0);
                       world.grant_in(FaultKind::foreign_write, "segment", 8, 8, 3);
                       world.process("p").start("main", [&world] {
                         auto& bytes = *static_cast<Bytes*>(map_segment());
                         bytes[9] = 0x17;
                         world.require(bytes[9] == 0x00, "zeroes");
                         world.require(bytes[9] == 0xff, "ones");
                         world.require(bytes[9] == 0x00, "one more, which wraps");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, other_segments_and_bytes_that_do_not_exist_are_never_damaged) {
  NeverStrikes strategy;
  EXPECT_EQ(run_under(strategy, 1,
                      [](World& world) {
                        world.grant_in(FaultKind::bit_flip, "another", 0, 16, 1);
                        world.grant_in(FaultKind::bit_flip, "segment", 4096, 16, 1);
                        world.process("p").start("main", [] { ++(*static_cast<Bytes*>(map_segment()))[0]; });
                      }),
            Outcome{});
}

// --- calls that fail, and what was left over ---

TEST_F(FaultsTest, opening_resizing_and_mapping_a_segment_fail_as_their_manual_pages_say) {
  EXPECT_EQ(run_with({"fault p/main before shm_open - #1 call-failure 1",
                      "fault p/main before shm_open - #2 call-failure 2",
                      "fault p/main before shm_open - #3 call-failure 3",
                      "fault p/main before shm_resize - #1 call-failure 1",
                      "fault p/main before shm_resize - #2 call-failure 2",
                      "fault p/main before shm_resize - #3 call-failure 3",
                      "fault p/main before shm_map - #1 call-failure 1",
                      "fault p/main before shm_map - #2 call-failure 2",
                      "fault p/main before shm_map - #3 call-failure 3"},
                     [](World& world) {
                       world.grant(FaultKind::call_failure, 9);
                       world.process("p").start("main", [&world] {
                         const auto open = [] { return shm_open("/segment", O_CREAT | O_RDWR, 0600); };
                         for (const int error : {EACCES, EMFILE, ENFILE})
                           world.require(open() == -1 && errno == error, "shm_open");
                         world.require(shm_open("/segment", O_RDWR, 0600) == -1 && errno == ENOENT,
                                       "what failed made nothing");
                         const int descriptor = open();
                         for (const int error : {EINTR, EFBIG, EIO})
                           world.require(ftruncate(descriptor, 4096) == -1 && errno == error, "ftruncate");
                         struct stat status{};
                         world.require(fstat(descriptor, &status) == 0 && status.st_size == 0,
                                       "nor did this");
                         world.require(ftruncate(descriptor, 4096) == 0, "used up");
                         const auto map = [descriptor] {
                           return mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
                         };
                         for (const int error : {EAGAIN, ENFILE, ENOMEM})
                           world.require(map() == MAP_FAILED && errno == error, "mmap");
                         world.require(map() != MAP_FAILED, "used up");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(FaultsTest, a_segment_and_a_semaphore_of_a_former_life_are_found_as_they_were_left) {
  EXPECT_EQ(run([](World& world) {
              const std::array<std::byte, 3> content{std::byte{7}, std::byte{8}, std::byte{9}};
              world.leave_segment("/segment", content);
              world.leave_semaphore("/s", 5);
              world.process("p").start("main", [&world] {
                world.require(shm_open("/segment", O_CREAT | O_EXCL | O_RDWR, 0600) == -1 && errno == EEXIST,
                              "it is there");
                const int descriptor = shm_open("/segment", O_RDWR, 0600);
                struct stat status{};
                world.require(fstat(descriptor, &status) == 0 && status.st_size == 3, "its size");
                auto& bytes =
                    *static_cast<Bytes*>(mmap(nullptr, 3, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
                world.require(bytes[0] == 7 && bytes[2] == 9 && bytes[3] == 0, "its content");
                world.require(value_of(sem_open("/s", 0)) == 5, "its value");
                world.require(sem_unlink("/s") == 0 && shm_unlink("/segment") == 0, "they can be removed");
                world.require(sem_open("/s", 0) == SEM_FAILED && errno == ENOENT, "and are gone");
              });
            }),
            Outcome{});
}

TEST_F(FaultsTest, what_cannot_be_granted_so_or_left_over_is_refused) {
  const std::array<void (*)(World&), 7> mistakes{
      [](World& world) { world.grant(FaultKind::crash, 1); },
      [](World& world) { world.grant(FaultKind::process_stall, 1); },
      [](World& world) { world.grant(FaultKind::bit_flip, 1); },
      [](World& world) { world.grant_in(FaultKind::lost_post, "segment", 0, 4, 1); },
      [](World& world) { world.leave_segment("a/b", {}); },
      [](World& world) { world.leave_semaphore("", 1); },
      [](World& world) {
        world.leave_semaphore("twice", 1);
        world.leave_semaphore("twice", 1);
      },
  };
  for (const auto mistake : mistakes) EXPECT_EQ(run(mistake).kind, OutcomeKind::unsupported);
}

}  // namespace
}  // namespace ltsim
