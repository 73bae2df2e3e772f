#include "sim_clock/clock/virtual_clock.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace ltsim {
namespace {

using namespace std::chrono_literals;

std::vector<TaskId> take_all_due(VirtualClock& clock) {
  std::vector<TaskId> sleepers;
  for (TaskId id = clock.take_due(); id != VirtualClock::no_task; id = clock.take_due())
    sleepers.push_back(id);
  return sleepers;
}

TEST(VirtualClock, begins_at_zero_with_no_timer_armed) {
  const VirtualClock clock;
  EXPECT_EQ(clock.now(), 0ns);
  EXPECT_FALSE(clock.any_armed());
  EXPECT_EQ(clock.next_deadline(), VirtualClock::never);
}

TEST(VirtualClock, a_timer_is_due_at_its_deadline_and_not_a_nanosecond_before) {  // I2
  VirtualClock clock;
  clock.arm(1ms, 7);
  clock.pass(1ms - 1ns);
  EXPECT_EQ(clock.take_due(), VirtualClock::no_task);
  clock.pass(1ns);
  EXPECT_EQ(clock.take_due(), 7);
  EXPECT_FALSE(clock.any_armed());
}

TEST(VirtualClock, a_deadline_in_the_past_is_due_at_once) {
  VirtualClock clock;
  clock.pass(5ms);
  clock.arm(1ms, 3);
  EXPECT_EQ(clock.take_due(), 3);
}

TEST(VirtualClock, timers_are_due_in_the_order_of_their_deadlines) {
  VirtualClock clock;
  const std::vector<int> deadlines_ms{5, 1, 4, 2, 8, 3, 7, 6};
  for (TaskId id = 0; id < deadlines_ms.size(); ++id)
    clock.arm(std::chrono::milliseconds{deadlines_ms[id]}, id);
  EXPECT_EQ(clock.next_deadline(), 1ms);
  clock.pass(8ms);
  EXPECT_EQ(take_all_due(clock), (std::vector<TaskId>{1, 3, 5, 2, 0, 7, 6, 4}));
}

TEST(VirtualClock, equal_deadlines_are_due_in_the_order_in_which_they_were_armed) {  // I3
  VirtualClock clock;
  for (const TaskId id : std::vector<TaskId>{4, 2, 9, 0, 7}) clock.arm(1ms, id);
  clock.pass(1ms);
  EXPECT_EQ(take_all_due(clock), (std::vector<TaskId>{4, 2, 9, 0, 7}));
}

TEST(VirtualClock, arming_again_replaces_the_deadline) {
  VirtualClock clock;
  clock.arm(1ms, 1);
  clock.arm(3ms, 1);
  clock.arm(2ms, 2);
  clock.pass(2ms);
  EXPECT_EQ(take_all_due(clock), (std::vector<TaskId>{2}));
  clock.pass(1ms);
  EXPECT_EQ(take_all_due(clock), (std::vector<TaskId>{1}));
}

TEST(VirtualClock, a_cancelled_timer_is_never_due_and_the_others_keep_their_order) {
  VirtualClock clock;
  for (TaskId id = 0; id < 20; ++id) clock.arm(std::chrono::milliseconds{(id * 7) % 20}, id);
  for (const TaskId id : std::vector<TaskId>{0, 2, 4, 6, 8, 10, 12, 14, 16, 18}) clock.cancel(id);
  clock.cancel(0);  // twice is nothing
  clock.pass(20ms);
  std::vector<TaskId> due = take_all_due(clock);
  ASSERT_EQ(due.size(), 10U);
  for (std::size_t i = 1; i < due.size(); ++i) EXPECT_LT((due[i - 1] * 7) % 20, (due[i] * 7) % 20);
}

// The timers lie in a heap; the last one fills the hole. Here it belongs above the hole: 4 ms under 10 ms
// would come too late.
//
//            1                    1
//       10       2     ->     4       2
//     11  12   3   4        10 12   3
TEST(VirtualClock, a_cancelled_timer_may_be_replaced_by_an_earlier_one) {
  VirtualClock clock;
  const auto arm_at_own_number = [&clock](const std::vector<TaskId>& milliseconds) {
    for (const TaskId id : milliseconds) clock.arm(std::chrono::milliseconds{id}, id);
  };
  arm_at_own_number({1, 10, 2, 11, 12, 3, 4});
  clock.cancel(11);
  arm_at_own_number({20, 21, 22});
  clock.pass(1s);
  EXPECT_EQ(take_all_due(clock), (std::vector<TaskId>{1, 2, 3, 4, 10, 12, 20, 21, 22}));
}

/// What the clock promises, without a heap.
class SortedTimers {
 public:
  void arm(SimTime deadline, TaskId sleeper) {
    cancel(sleeper);
    const auto later = std::find_if(timers_.begin(), timers_.end(),
                                    [deadline](const Timer& timer) { return timer.deadline > deadline; });
    timers_.insert(later, Timer{deadline, sleeper});
  }
  void cancel(TaskId sleeper) {
    std::erase_if(timers_, [sleeper](const Timer& timer) { return timer.sleeper == sleeper; });
  }
  [[nodiscard]] SimTime next_deadline() const {
    return timers_.empty() ? VirtualClock::never : timers_.front().deadline;
  }
  std::vector<TaskId> take_all_due(SimTime now) {
    std::vector<TaskId> sleepers;
    while (next_deadline() <= now && !timers_.empty()) {
      sleepers.push_back(timers_.front().sleeper);
      timers_.erase(timers_.begin());
    }
    return sleepers;
  }

 private:
  struct Timer {
    SimTime deadline;
    TaskId sleeper;
  };
  std::vector<Timer> timers_;
};

TEST(VirtualClock, any_sequence_of_calls_gives_what_a_sorted_list_gives) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 random{seed};
    const auto below = [&random](unsigned limit) { return static_cast<unsigned>(random() % limit); };
    VirtualClock clock;
    SortedTimers reference;
    for (int step = 0; step < 300; ++step) {
      const auto sleeper = static_cast<TaskId>(below(60));
      if (const unsigned action = below(20); action < 12) {
        const SimTime deadline = clock.now() + SimTime{below(80)};  // few, so that many are equal
        clock.arm(deadline, sleeper);
        reference.arm(deadline, sleeper);
      } else if (action < 19) {
        clock.cancel(sleeper);
        reference.cancel(sleeper);
      } else {
        clock.pass(SimTime{below(20)});
        ASSERT_EQ(take_all_due(clock), reference.take_all_due(clock.now()))
            << "seed " << seed << ", step " << step;
      }
      ASSERT_EQ(clock.next_deadline(), reference.next_deadline()) << "seed " << seed << ", step " << step;
    }
    clock.pass(1s);
    ASSERT_EQ(take_all_due(clock), reference.take_all_due(clock.now())) << "seed " << seed;
  }
}

TEST(VirtualClock, reset_puts_it_back_to_the_beginning) {
  VirtualClock clock;
  clock.arm(1ms, 1);
  clock.pass(2ms);
  clock.reset();
  EXPECT_EQ(clock.now(), 0ns);
  EXPECT_FALSE(clock.any_armed());
  clock.arm(1ms, 1);
  EXPECT_EQ(clock.next_deadline(), 1ms);
}

}  // namespace
}  // namespace ltsim
