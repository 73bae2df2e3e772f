// The layering of the design, and the checker of the layering tried on trees that break it.

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include "tests/house/include_rules.hpp"

namespace house {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(Layering, holds_in_this_project) {
  for (const ForbiddenInclude& found : forbidden_includes(LTSIM_SOURCE_DIR))
    ADD_FAILURE() << to_string(found);
}

TEST(Layering, is_read_from_the_files_of_every_folder_it_speaks_of) {
  for (const char* folder : {"sim_clock", "protocol", "emulator_models", "kernel_mocks"})
    EXPECT_TRUE(fs::is_directory(fs::path(LTSIM_SOURCE_DIR) / folder)) << folder;
}

/// A project of one file in a temporary folder.
class SampleTree : public testing::Test {
 protected:
  SampleTree() : root_(fs::temp_directory_path() / ("house-test-" + std::to_string(::getpid()))) {
    fs::remove_all(root_);
  }
  ~SampleTree() override { fs::remove_all(root_); }

  std::vector<std::string> check(const fs::path& file, std::string_view contents) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << contents;
    std::vector<std::string> lines;
    for (const ForbiddenInclude& found : forbidden_includes(root_)) lines.push_back(to_string(found));
    return lines;
  }

  fs::path root_;
};

TEST_F(SampleTree, every_never_of_the_design_is_found) {
  struct Never {
    std::string_view from;
    std::string_view to;
  };
  constexpr Never nevers[] = {
      {"sim_clock", "protocol"},
      {"sim_clock", "emulator_models"},
      {"sim_clock", "kernel_mocks"},
      {"protocol", "sim_clock"},
      {"emulator_models", "sim_clock"},
      {"kernel_mocks", "sim_clock"},
      {"protocol", "tests"},
      {"emulator_models", "tests"},
      {"kernel_mocks", "tests"},
      {"kernel_mocks", "emulator_models"},
      {"emulator_models", "kernel_mocks"},
      {"protocol", "emulator_models"},
      {"protocol", "kernel_mocks"},
  };
  for (const auto& [from, to] : nevers) {
    const std::string file = std::string(from) + "/a.hpp";
    const std::string include = "#include \"" + std::string(to) + "/b.hpp\"\n";
    EXPECT_THAT(check(file, include), ElementsAre(file + ":1: includes " + std::string(to)));
    fs::remove_all(root_);
  }
}

TEST_F(SampleTree, the_line_is_named) {
  EXPECT_THAT(
      check("protocol/a.cpp", "#include \"protocol/a.hpp\"\n\n#include \"sim_clock/world/world.hpp\"\n"),
      ElementsAre("protocol/a.cpp:3: includes sim_clock"));
}

TEST_F(SampleTree, angle_brackets_blanks_and_tabs_hide_nothing) {
  EXPECT_THAT(check("protocol/a.cpp",
                    "#include <sim_clock/a.hpp>\n"
                    "  #\tinclude\t<sim_clock/a.hpp> // why\n"
                    "#include\"sim_clock/a.hpp\"\n"),
              ElementsAre("protocol/a.cpp:1: includes sim_clock", "protocol/a.cpp:2: includes sim_clock",
                          "protocol/a.cpp:3: includes sim_clock"));
}

TEST_F(SampleTree, a_way_over_the_parent_folder_hides_nothing) {
  EXPECT_THAT(
      check("protocol/fx/a.cpp",
            "#include \"../../sim_clock/a.hpp\"\n"
            "#include \"protocol/../kernel_mocks/a.hpp\"\n"
            "#include <./emulator_models/a.hpp>\n"),
      ElementsAre("protocol/fx/a.cpp:1: includes sim_clock", "protocol/fx/a.cpp:2: includes kernel_mocks",
                  "protocol/fx/a.cpp:3: includes emulator_models"));
}

TEST_F(SampleTree, headers_and_deep_folders_are_read_too) {
  EXPECT_THAT(check("kernel_mocks/a/b/c.h", "#include \"emulator_models/a.hpp\"\n"),
              ElementsAre("kernel_mocks/a/b/c.h:1: includes emulator_models"));
}

TEST_F(SampleTree, what_the_design_allows_is_not_reported) {
  EXPECT_THAT(check("kernel_mocks/a.cpp",
                    "#include \"protocol/serial_port.hpp\"\n"
                    "#include \"kernel_mocks/a.hpp\"\n"
                    "#include \"a.hpp\"\n"
                    "#include <vector>\n"),
              IsEmpty());
  EXPECT_THAT(check("tests/scenarios/a.cpp",
                    "#include \"sim_clock/a.hpp\"\n"
                    "#include \"kernel_mocks/a.hpp\"\n"),
              IsEmpty());
}

TEST_F(SampleTree, text_that_is_not_an_include_is_not_reported) {
  EXPECT_THAT(check("protocol/a.cpp",
                    "// #include \"sim_clock/a.hpp\"\n"
                    "const char* text = \"#include <sim_clock/a.hpp>\";\n"),
              IsEmpty());
}

}  // namespace
}  // namespace house
