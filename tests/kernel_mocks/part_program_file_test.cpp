#include "kernel_mocks/part_program_file.hpp"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/shell.hpp"

namespace kernel_mocks {
namespace {

class PartProgramFile : public testing::Test {
 protected:
  [[nodiscard]] std::string file_with(std::string_view text) const {
    const auto path = folder_.path() / "program.nc";
    std::ofstream{path, std::ios::binary} << text;
    return path.string();
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(PartProgramFile, is_read_as_it_is) {
  EXPECT_EQ(read_program_file(file_with("%\r\nM30\n")).value(), "%\r\nM30\n");
}

TEST_F(PartProgramFile, may_be_empty) { EXPECT_EQ(read_program_file(file_with("")).value(), ""); }

TEST_F(PartProgramFile, that_does_not_exist_cannot_be_opened) {
  EXPECT_EQ(read_program_file("/no/such/file.nc").error(), FileError::cannot_open);
}

TEST_F(PartProgramFile, that_is_a_folder_cannot_be_opened) {
  EXPECT_EQ(read_program_file("/").error(), FileError::cannot_open);
}

TEST_F(PartProgramFile, may_be_as_long_as_the_limit_and_not_a_byte_longer) {
  const std::string path = file_with("0123456789");
  EXPECT_TRUE(read_program_file(path, 10).has_value());
  EXPECT_EQ(read_program_file(path, 9).error(), FileError::too_long);
}

}  // namespace
}  // namespace kernel_mocks
