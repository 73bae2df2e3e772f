// What the console shows of the memory.
#include "emulator_models/plc_view.hpp"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator_models/special_devices.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using ::testing::HasSubstr;
using ::testing::Not;

struct PlcViewTest : ::testing::Test {
  DeviceMemory memory{protocol::fx::Model::fx3u};

  [[nodiscard]] PlcView view_of(PlcView::Style style) const {
    return PlcView{style, memory, labels_of(PlantKind::machine_tool)};
  }
};

TEST_F(PlcViewTest, lines_name_the_device_its_change_and_its_meaning) {
  PlcView view = view_of(PlcView::Style::lines);
  EXPECT_EQ(view.update(memory, 0s), "");
  memory.set({DeviceKind::y, 0}, 1);
  memory.set({DeviceKind::d, 101}, 1000);
  EXPECT_EQ(view.update(memory, 1250ms),
            "    1.250 s  Y0         0 -> 1      spindle cw\n"
            "    1.250 s  D101       0 -> 1000   S value\n");
  EXPECT_EQ(view.update(memory, 2s), "");
}

TEST_F(PlcViewTest, a_device_without_a_meaning_is_shown_all_the_same) {
  PlcView view = view_of(PlcView::Style::lines);
  memory.set({DeviceKind::d, 4711}, 5);
  EXPECT_THAT(view.update(memory, 0s), HasSubstr("D4711"));
}

TEST_F(PlcViewTest, what_changes_by_itself_is_no_change) {
  PlcView view = view_of(PlcView::Style::lines);
  set_clock_flags(memory, 55ms);
  set_calendar(memory, WallTime{} + 3723s);
  memory.set({DeviceKind::d, 8010}, 30);
  EXPECT_EQ(view.update(memory, 0s), "");
}

TEST_F(PlcViewTest, a_screen_is_drawn_at_first_and_after_a_change_only) {
  PlcView view = view_of(PlcView::Style::screen);
  EXPECT_THAT(view.update(memory, 0s), HasSubstr("FX3U in STOP"));
  EXPECT_EQ(view.update(memory, 1s), "");
  set_run_flags(memory, RunMode::run);
  EXPECT_THAT(view.update(memory, 2s), HasSubstr("FX3U in RUN"));
}

TEST_F(PlcViewTest, a_screen_says_which_error_lamp_is_lit) {
  PlcView view = view_of(PlcView::Style::screen);
  EXPECT_THAT(view.update(memory, 0s), Not(HasSubstr("-E,")));
  memory.set({DeviceKind::m, 8061}, 1);
  EXPECT_THAT(view.update(memory, 1s), HasSubstr("FX3U in STOP, CPU-E,"));
  memory.set({DeviceKind::m, 8061}, 0);
  memory.set({DeviceKind::m, 8067}, 1);
  EXPECT_THAT(view.update(memory, 2s), HasSubstr("FX3U in STOP, PROG-E,"));
}

TEST_F(PlcViewTest, a_screen_of_a_small_model_leaves_out_what_it_has_not) {
  const DeviceMemory small{protocol::fx::Model::fx1s};
  PlcView view{PlcView::Style::screen, small, labels_of(PlantKind::machine_tool)};
  const std::string screen = view.update(small, 0s);
  EXPECT_THAT(screen, HasSubstr("X17 "));
  EXPECT_THAT(screen, Not(HasSubstr("X20 ")));
}

TEST(DeviceLabels, of_every_plant_fit_their_column_and_name_a_device_once) {
  for (const PlantKind plant : {PlantKind::machine_tool, PlantKind::propulsion, PlantKind::none}) {
    std::set<std::string> devices;
    for (const DeviceLabel& label : labels_of(plant)) {
      EXPECT_LE(label.text.size(), 19U) << label.text;
      EXPECT_TRUE(devices.insert(protocol::fx::to_string(label.device)).second) << label.text;
    }
  }
}

TEST_F(PlcViewTest, a_screen_keeps_the_last_changes) {
  PlcView view = view_of(PlcView::Style::screen);
  std::string screen;
  for (std::uint16_t number = 1; number <= 20; ++number) {
    memory.set({DeviceKind::d, number}, 1);
    screen = view.update(memory, 1s);
  }
  EXPECT_THAT(screen, HasSubstr("D20 "));
  EXPECT_THAT(screen, HasSubstr("D9 "));
  EXPECT_THAT(screen, Not(HasSubstr("D8 ")));
}

}  // namespace
}  // namespace emulator_models
