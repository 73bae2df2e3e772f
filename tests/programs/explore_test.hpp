// What tests of ltsim-cc, ltsim-c++ and "ltsim explore" over what they have built share: a folder of their own, and the commands in it.
#pragma once

#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/support/shell.hpp"

namespace program_tests {

using Result = test_support::ShellResult;

class ExploreTest : public testing::Test {
 protected:
  [[nodiscard]] Result shell(const std::string& line) const {
    return test_support::run_in(folder_.path(), line);
  }
  [[nodiscard]] Result ltsim(const std::string& arguments) const {
    return shell(LTSIM_PROGRAM " " + arguments);
  }
  /// @param arguments  for the C++ compiler's driver
  [[nodiscard]] Result compile(const std::string& arguments) const {
    return shell("LTSIM_CXX='" CXX_COMPILER "' " LTSIM_CXX " -std=c++20 -O1 " + arguments);
  }
  /// The program "p" from this source.
  void build(const std::string& name, const std::string& source, const std::string& options = "") const {
    write(name, source);
    const Result built = compile(options + " " + name + " -o p");
    ASSERT_EQ(built.exit_code, 0) << built.output;
  }
  /// @param name  of a program that was built from a source in this folder
  [[nodiscard]] static std::string path_of(std::string_view name) {
    return std::string{PROGRAMS_FOLDER "/"}.append(name);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_.path() / name} << text;
  }
  [[nodiscard]] std::string read(const char* name) const {
    std::ifstream file{folder_.path() / name};
    return {std::istreambuf_iterator<char>{file}, {}};
  }
  [[nodiscard]] static bool contains(std::string_view text, std::string_view what) {
    return text.find(what) != std::string_view::npos;
  }
  [[nodiscard]] static bool contains(const Result& result, std::string_view what) {
    return contains(result.output, what);
  }

  test_support::TemporaryFolder folder_;
};

}  // namespace program_tests
