// The top-level folders are given; nothing else joins them.

#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/house/command_output.hpp"

namespace house {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// @param files  one path a line, as git ls-files prints them
/// @return top-level folders that the design does not know
std::set<std::string> unknown_folders(const std::string& files) {
  const std::set<std::string> known{".ci",          "sim_clock", "protocol",       "emulator_models",
                                    "kernel_mocks", "fuzz",      "property_tests", "tests"};
  std::set<std::string> unknown;
  std::istringstream lines(files);
  for (std::string file; std::getline(lines, file);) {
    const std::size_t slash = file.find('/');
    if (slash == std::string::npos) continue;
    const std::string folder = file.substr(0, slash);
    if (!known.contains(folder)) unknown.insert(folder);
  }
  return unknown;
}

TEST(TopLevelFolders, are_those_of_the_design) {
  const auto files = output_of("git -C '" LTSIM_SOURCE_DIR "' ls-files");
  if (!files || files->empty()) GTEST_SKIP() << "not a git checkout";
  EXPECT_THAT(unknown_folders(*files), IsEmpty());
}

TEST(TopLevelFolders, that_the_design_does_not_know_are_reported_once) {
  EXPECT_THAT(unknown_folders("README.md\nutil/a.hpp\nprotocol/a.hpp\nutil/b.hpp\ndocs/x/y.md\n"),
              ElementsAre("docs", "util"));
}

}  // namespace
}  // namespace house
