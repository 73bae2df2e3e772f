// What the README shows is what the programs print. A block that begins with "    $ ltsim ..." is run, and
// must give the lines below it.

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/shell.hpp"

namespace {

const std::string shown_program = "./build/release/bin/ltsim";
const std::string indent = "    ";

std::vector<std::string> lines_of(std::istream& stream) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
  return text;
}

class ReadmeTest : public testing::Test {
 protected:
  ReadmeTest() {
    std::ifstream readme{LTSIM_SOURCE_DIR "/README.md"};
    readme_ = lines_of(readme);
  }

  /// What the command prints, with the program as the README calls it.
  std::vector<std::string> run(const std::string& command) const {
    const std::string line =
        replaced(replaced(command, shown_program, LTSIM_PROGRAM), " ./two_stage", " " TWO_STAGE_PROGRAM);
    std::istringstream output{
        replaced(test_support::run_in(folder_.path(), line).output, LTSIM_PROGRAM, shown_program)};
    return lines_of(output);
  }

  /// Lines from `begin` to the next blank one, without the indent.
  [[nodiscard]] std::vector<std::string> block_at(std::size_t begin) const {
    std::vector<std::string> block;
    for (std::size_t i = begin; i < readme_.size() && readme_[i].starts_with(indent); ++i) {
      block.push_back(readme_[i].substr(indent.size()));
    }
    return block;
  }

  test_support::TemporaryFolder folder_;
  std::vector<std::string> readme_;
};

TEST_F(ReadmeTest, commands_print_what_is_shown) {
  int commands = 0;
  for (std::size_t i = 0; i < readme_.size(); ++i) {
    if (!readme_[i].starts_with(indent + "$ ")) continue;
    ++commands;
    EXPECT_EQ(run(readme_[i].substr(indent.size() + 2)), block_at(i + 1)) << readme_[i];
  }
  EXPECT_EQ(commands, 3);
}

}  // namespace
