// The operator's panel, and who presses it: a script, or chance.
#include "kernel_mocks/operator_panel.hpp"

#include <gtest/gtest.h>

namespace kernel_mocks {
namespace {

using namespace std::chrono_literals;
using enum OperatorEvent;
using Events = std::vector<OperatorEvent>;

Events taken(OperatorPanel& panel) {
  Events events;
  while (const auto event = panel.take()) events.push_back(*event);
  return events;
}

TEST(OperatorPanel, hands_out_each_event_once_in_the_order_in_which_they_were_pressed) {
  OperatorPanel panel;
  panel.press(feed_hold);
  panel.press(cycle_start);
  panel.press(feed_hold);
  EXPECT_EQ(taken(panel), (Events{feed_hold, cycle_start, feed_hold}));
  EXPECT_EQ(panel.take(), std::nullopt);
}

TEST(ScriptedOperator, presses_at_its_times_and_not_a_nanosecond_before_and_each_once) {
  ScriptedOperator scripted{{{100ms, feed_hold}, {200ms, cycle_start}}};
  OperatorPanel panel;
  scripted.look(100ms - 1ns, panel);
  EXPECT_EQ(taken(panel), Events{});
  scripted.look(100ms, panel);
  EXPECT_EQ(taken(panel), Events{feed_hold});
  scripted.look(150ms, panel);
  EXPECT_EQ(taken(panel), Events{});
  scripted.look(1s, panel);
  EXPECT_EQ(taken(panel), Events{cycle_start});
}

TEST(ScriptedOperator, presses_what_is_due_at_one_look_in_the_order_of_the_script) {
  ScriptedOperator scripted{{{200ms, cycle_start}, {100ms, feed_hold}}};
  OperatorPanel panel;
  scripted.look(1s, panel);
  EXPECT_EQ(taken(panel), (Events{cycle_start, feed_hold}));
}

TEST(ScriptedOperator, presses_when_its_block_begins_the_first_time) {
  ScriptedOperator scripted{{{std::uint32_t{20}, feed_hold}}};
  OperatorPanel panel;
  scripted.block_begun(10, panel);
  scripted.look(1h, panel);
  EXPECT_EQ(taken(panel), Events{});
  scripted.block_begun(20, panel);
  scripted.block_begun(20, panel);
  EXPECT_EQ(taken(panel), Events{feed_hold});
}

TEST(ScriptedOperator, has_left_when_no_entry_with_a_time_is_left) {
  ScriptedOperator scripted{{{100ms, feed_hold}, {std::uint32_t{20}, feed_hold}}};
  OperatorPanel panel;
  EXPECT_FALSE(scripted.has_left());
  scripted.look(100ms, panel);
  EXPECT_TRUE(scripted.has_left());
}

TEST(RandomOperator, presses_at_each_interval_what_was_chosen_or_cycle_start) {
  std::vector<std::uint32_t> choices{2, 0, 1};
  std::size_t next = 0;
  RandomOperator chance{{feed_hold, plc_stop}, 1s, [&](std::uint32_t bound) {
                          EXPECT_EQ(bound, 3U);
                          return choices.at(next++);
                        }};
  OperatorPanel panel;
  chance.look(0ms, panel);
  chance.look(999ms, panel);
  EXPECT_EQ(taken(panel), Events{plc_stop});
  chance.look(1s, panel);
  EXPECT_EQ(taken(panel), Events{cycle_start});
  chance.look(2s, panel);
  EXPECT_EQ(taken(panel), Events{feed_hold});
}

TEST(RandomOperator, does_not_make_up_for_intervals_in_which_nobody_looked_and_never_leaves) {
  unsigned asked = 0;
  RandomOperator chance{{feed_hold}, 1s, [&](std::uint32_t) { return ++asked, 0U; }};
  OperatorPanel panel;
  chance.look(10s, panel);
  chance.look(10s + 999ms, panel);
  EXPECT_EQ(asked, 1U);
  EXPECT_FALSE(chance.has_left());
}

}  // namespace
}  // namespace kernel_mocks
