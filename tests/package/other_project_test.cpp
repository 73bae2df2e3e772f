// The program of the project tests/consumer/, which has its scenarios from its own sources and the rest from the package.
//
// One of its threads is started by libstdc++: a program that does not link the world as a whole has it run outside of the world.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/shell.hpp"

namespace {

using testing::EndsWith;
using testing::HasSubstr;

class OtherProject : public testing::Test {
 protected:
  [[nodiscard]] test_support::ShellResult car_park_scenarios(const std::string& arguments) const {
    return test_support::run_in(folder_.path(), CAR_PARK_SCENARIOS " " + arguments);
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(OtherProject, has_the_command_line_over_its_own_scenarios_alone) {
  const auto listed = car_park_scenarios("list");
  EXPECT_EQ(listed.exit_code, 0);
  EXPECT_EQ(listed.output,
            "car-park/look-then-take  a gate looks whether a place is free, and takes it then\n"
            "car-park/take            a gate takes a place if one is free, in one step\n");
}

TEST_F(OtherProject, has_its_race_found_made_small_and_replayed) {
  const auto found = car_park_scenarios("explore car-park/look-then-take");
  EXPECT_EQ(found.exit_code, 1) << found.output;
  EXPECT_THAT(found.output, HasSubstr("invariant: as many cars as places"));
  EXPECT_THAT(
      found.output,
      HasSubstr("switch    north/main       before atomic_update car-park.free #1        to south/main"));
  const std::string schedule = "out/car-park-look-then-take.schedule";
  EXPECT_THAT(found.output, HasSubstr("replay:  " CAR_PARK_SCENARIOS " replay " + schedule));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / schedule));

  const auto replayed = car_park_scenarios("replay " + schedule);
  EXPECT_EQ(replayed.exit_code, 1) << replayed.output;
  EXPECT_THAT(replayed.output, HasSubstr("invariant: as many cars as places"));
  EXPECT_EQ(car_park_scenarios("minimize " + schedule).exit_code, 1);
}

TEST_F(OtherProject, has_nothing_found_and_a_proof_where_the_race_is_corrected) {
  const auto explored = car_park_scenarios("explore car-park/take --executions 5000");
  EXPECT_EQ(explored.exit_code, 0) << explored.output;
  EXPECT_THAT(explored.output, HasSubstr("nothing found: 5000 executions"));
  const auto proved = car_park_scenarios("prove car-park/take");
  EXPECT_EQ(proved.exit_code, 0) << proved.output;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream{file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

TEST(BuildFileInTheReadme, is_that_of_the_other_project) {
  const std::string readme = text_of(LTSIM_SOURCE_DIR "/README.md");
  const std::string opening = "```cmake\n";
  const std::size_t begin = readme.find(opening);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = readme.find("```", begin + opening.size());
  const std::string shown = readme.substr(begin + opening.size(), end - begin - opening.size());
  EXPECT_THAT(text_of(LTSIM_SOURCE_DIR "/tests/consumer/CMakeLists.txt"), EndsWith(shown));
}

}  // namespace
