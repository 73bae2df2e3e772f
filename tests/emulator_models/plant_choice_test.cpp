// Plants and their failures by name.
#include "emulator_models/plant_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator_models/plants/machine_tool_wiring.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using machine_tool::X;
using ::testing::HasSubstr;

TEST(PlantChoice, each_plant_is_known_by_its_name) {
  for (const PlantKind kind : {PlantKind::machine_tool, PlantKind::propulsion, PlantKind::none})
    EXPECT_EQ(parse_plant(to_string(kind)), kind);
  EXPECT_EQ(parse_plant("machine_tool"), std::nullopt);
}

TEST(PlantChoice, a_failure_is_in_force_from_its_second_on_counted_from_the_first_scan) {
  const auto plant = make_plant(PlantKind::machine_tool, {"spindle-drive-fault@1.5", "over-travel"});
  ASSERT_TRUE(plant.has_value()) << plant.error();
  Terminals terminals;
  const auto at = [&](std::chrono::nanoseconds after) {
    (*plant)(terminals, SteadyTime{1h} + after);
    return terminals.inputs.test(index_of(X::spindle_drive_fault));
  };
  EXPECT_FALSE(at(0ns));
  EXPECT_FALSE(terminals.inputs.test(index_of(X::over_travel_free)));
  EXPECT_FALSE(at(1500ms - 1ns));
  EXPECT_TRUE(at(1500ms));
  EXPECT_TRUE(at(1h));
}

TEST(PlantChoice, a_failure_that_is_not_known_is_refused_with_the_list_of_those_that_are) {
  const auto error = [](PlantKind kind, const char* failure) { return make_plant(kind, {failure}).error(); };
  EXPECT_THAT(error(PlantKind::machine_tool, "fire"), HasSubstr("spindle-drive-fault, flood-without-flow"));
  EXPECT_THAT(error(PlantKind::propulsion, "fire@3"), HasSubstr("shaft-blocked, speed-sensor-broken"));
  EXPECT_THAT(error(PlantKind::none, "fire"), HasSubstr("no machine"));
  for (const char* const failure : {"arm-stuck@", "arm-stuck@x", "arm-stuck@-1", "arm-stuck@1e3",
                                    "arm-stuck@nan", "arm-stuck@1000001", "arm-stuck@1@2"})
    EXPECT_THAT(error(PlantKind::machine_tool, failure), HasSubstr("a number of seconds")) << failure;
}

}  // namespace
}  // namespace emulator_models
