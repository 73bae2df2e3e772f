// Stalls of a process: none of its tasks gets a processor, and the rest of the world goes on.

#include <fcntl.h>
#include <semaphore.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/sim_clock/faults_fixture.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

class ProcessStallTest : public FaultsTest {};

sem_t* bell() { return sem_open("/bell", O_CREAT, 0600, 0U); }

TEST_F(ProcessStallTest, all_tasks_of_the_process_stand_still_and_others_go_on) {
  EXPECT_EQ(run_with({"fault victim/one before sem_post bell #1 process-stall 2"},  // 10 ms
                     [](World& world) {
                       world.process("victim").may_stall(1);
                       world.process("victim").start("one", [] { sem_post(bell()); });
                       world.process("victim").start("two", [&world] {
                         sched_yield();
                         world.require(world.now() >= 10ms, "two stands still as well");
                       });
                       world.process("witness").start("main", [&world] {
                         sched_yield();
                         world.require(world.now() < 1ms, "the witness does not");
                         sem_wait(bell());
                         world.require(world.now() >= 10ms && world.now() < 11ms,
                                       "the post comes after the stall");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(ProcessStallTest, who_is_woken_meanwhile_goes_on_when_it_is_over) {
  EXPECT_EQ(run_with({"fault witness/main before sem_post bell #1 process-stall 3"},  // 100 ms
                     [](World& world) {
                       world.process("victim").may_stall(1);
                       world.process("victim").start("waits", [&world] {
                         sem_wait(bell());
                         world.require(world.now() >= 100ms, "waited for a post");
                       });
                       world.process("victim").start("sleeps", [&world] {
                         std::this_thread::sleep_for(20ms);
                         world.require(world.now() >= 100ms, "slept");
                       });
                       world.process("witness").start("main", [] {
                         std::this_thread::sleep_for(1ms);
                         sem_post(bell());
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(ProcessStallTest, a_time_out_that_passes_meanwhile_is_seen_with_what_has_come_meanwhile) {
  EXPECT_EQ(run_with({"fault witness/main before sleep - #1 process-stall 3"},
                     [](World& world) {
                       world.process("victim").may_stall(1);
                       world.process("victim").start("main", [&world] {
                         timespec deadline{};
                         clock_gettime(CLOCK_REALTIME, &deadline);
                         deadline.tv_sec += 1;
                         deadline.tv_nsec = 0;
                         world.require(sem_timedwait(bell(), &deadline) == 0, "the token is there");
                       });
                       world.process("witness").start("main", [] {
                         std::this_thread::sleep_for(20ms);
                         sem_post(bell());
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(ProcessStallTest, each_granted_process_has_its_own_numbers) {
  EXPECT_EQ(run_with({"fault one/main before sleep - #1 process-stall 6"},  // the second one, 1 ms
                     [](World& world) {
                       world.process("one").may_stall(1);
                       world.process("two").may_stall(1);
                       world.process("one").start("main", [&world] {
                         std::this_thread::sleep_for(10us);
                         world.require(world.now() < 1ms, "one goes on");
                       });
                       world.process("two").start("main", [&world] {
                         sched_yield();
                         world.require(world.now() >= 1ms, "two does not");
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(ProcessStallTest, a_stalled_process_can_be_killed_and_its_next_life_is_not_stalled) {
  EXPECT_EQ(run_with({"fault witness/main before sleep - #1 process-stall 4",  // 1 s
                      "crash witness/main before sleep - #2 of victim"},
                     [](World& world) {
                       world.process("victim").may_stall(1);
                       world.process("victim").may_crash({.times = 1, .restart_after = 1ms});
                       world.process("victim").start("main", [&world] {
                         sched_yield();
                         world.require(world.process("victim").incarnation() == 2 && world.now() < 100ms,
                                       "it is the next life that goes on");
                       });
                       world.process("witness").start("main", [] {
                         std::this_thread::sleep_for(10ms);
                         std::this_thread::sleep_for(10ms);
                       });
                       world.run();
                     }),
            Outcome{});
}

TEST_F(ProcessStallTest, the_grant_of_one_process_is_not_used_up_by_another) {
  EXPECT_EQ(
      run_with({"fault one/main before yield - #1 process-stall 1",
                "fault one/main before yield - #2 process-stall 1",  // one has had its own: nothing happens
                "fault one/main before yield - #3 process-stall 6"},
               [](World& world) {
                 for (int i = 0; i < 20; ++i)
                   world.process("one").may_stall(0);  // grants nothing, however often
                 world.process("one").may_stall(1);
                 world.process("two").may_stall(1);
                 world.process("two").start("main", [&world] {
                   std::this_thread::sleep_for(1500us);  // while one is stalled
                   sched_yield();
                   world.require(world.now() >= 2ms, "two is stalled in its turn");
                 });
                 world.process("one").start("main", [&world] {
                   std::this_thread::sleep_for(100us);
                   sched_yield();
                   sched_yield();
                   world.require(world.now() < 2ms, "one is stalled once");
                   sched_yield();
                 });
                 world.run();
               }),
      Outcome{});
}

TEST_F(ProcessStallTest, no_more_often_than_granted) {
  const auto body = [](World& world) {
    world.process("victim").may_stall(2);
    world.process("victim").start("main", [] {
      for (int i = 0; i < 10; ++i) sched_yield();
    });
    world.run();
  };
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Failure recorded = record_and_replay(seed, body);
    std::size_t stalls = 0;
    for (const Deviation& line : recorded.schedule.deviations)
      stalls += line.kind == Deviation::Kind::fault && line.fault == FaultKind::process_stall ? 1U : 0U;
    EXPECT_LE(stalls, 2U);
  }
}

/// Of the last execution.
SimTime held_up{};

/// One task sleeps for 10 ms, one takes a step and may be kept from it.
void a_sleeper_and_a_worker(World& world) {
  held_up = SimTime{0};
  world.whenever_held_up([](SimTime duration) { held_up += duration; });
  world.process("sleeper").start("main", [] { std::this_thread::sleep_for(10ms); });
  world.process("worker").may_stall(1);
  world.process("worker").start("main", [] {
    sched_yield();
    sched_yield();
  });
  world.run();
}

TEST_F(ProcessStallTest, time_for_which_somebody_could_have_gone_on_is_told) {
  const auto held_up_with = [](const std::vector<std::string>& lines) {
    EXPECT_EQ(run_with(lines, a_sleeper_and_a_worker), Outcome{});
    return held_up;
  };
  EXPECT_EQ(held_up_with({}), 0ms) << "who sleeps is not held up";
  EXPECT_EQ(held_up_with({"time worker/main before yield - #2 +3ms"}), 3ms);
  EXPECT_EQ(held_up_with({"stall worker/main before yield - #2 +3ms"}), 3ms);
  EXPECT_EQ(held_up_with({"fault worker/main before yield - #2 process-stall 1"}), 1ms);
}

}  // namespace
}  // namespace ltsim
