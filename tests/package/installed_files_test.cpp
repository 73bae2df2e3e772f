// What is installed is complete, and is nothing of the project's own.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const fs::path include_folder{INSTALLED_HEADERS};

std::string text_of(const fs::path& file) {
  std::ifstream stream{file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

/// What the file includes, as it is spelled, in quotes as well as in angle brackets.
std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex directive{R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])", std::regex::multiline};
  const std::string text = text_of(file);
  std::vector<std::string> includes;
  for (std::sregex_iterator match{text.begin(), text.end(), directive}, end; match != end; ++match)
    includes.push_back((*match)[1]);
  return includes;
}

std::set<std::string> installed_headers() {
  std::set<std::string> headers;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(include_folder))
    if (entry.is_regular_file()) headers.insert(entry.path().lexically_relative(include_folder).string());
  return headers;
}

/// The headers that an author of scenarios includes, and all of sim_clock that these include.
std::set<std::string> needed_headers() {
  std::set<std::string> needed;
  std::vector<std::string> waiting{"sim_clock/check/history.hpp", "sim_clock/scenario/command_line.hpp",
                                   "sim_clock/scenario/scenario.hpp", "sim_clock/scenario/shape.hpp"};
  while (!waiting.empty()) {
    const std::string header = std::move(waiting.back());
    waiting.pop_back();
    if (!needed.insert(header).second) continue;
    for (const std::string& included : includes_of(fs::path{LTSIM_SOURCE_DIR} / header))
      if (included.starts_with("sim_clock/")) waiting.push_back(included);
  }
  return needed;
}

TEST(InstalledHeaders, are_those_of_an_author_of_scenarios_and_what_they_include) {
  EXPECT_EQ(installed_headers(), needed_headers());
}

// Another one would have to be found by ltsimConfig.cmake, and linked by ltsim::world.
TEST(InstalledHeaders, include_of_other_libraries_only_those_that_the_package_finds) {
  std::set<std::string> others;
  for (const std::string& header : installed_headers())
    for (const std::string& included : includes_of(include_folder / header)) {
      const std::size_t slash = included.find('/');
      if (slash != std::string::npos) others.insert(included.substr(0, slash));
    }
  EXPECT_THAT(others, ElementsAre("fmt", "sim_clock", "sys"));
}

TEST(InstalledPackage, says_nothing_of_this_project_s_folders_and_options) {
  std::size_t files_count = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(INSTALLED_PACKAGE)) {
    if (entry.path().extension() != ".cmake") continue;
    ++files_count;
    const std::string text = text_of(entry.path());
    for (const char* ours :
         {LTSIM_SOURCE_DIR, "-Werror", "-Wall", "ltsim_options", "ltsim_precompiled", "CCACHE"})
      EXPECT_THAT(text, Not(HasSubstr(ours))) << entry.path();
  }
  EXPECT_GE(files_count, 4U) << "nothing was looked at";
}

}  // namespace
