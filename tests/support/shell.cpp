#include "tests/support/shell.hpp"

#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

namespace test_support {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "ltsim-test-XXXXXX").string();
  path_ = mkdtemp(name.data());
}

TemporaryFolder::~TemporaryFolder() { std::filesystem::remove_all(path_); }

ShellResult run_in(const std::filesystem::path& folder, const std::string& line) {
  FILE* const pipe = popen(fmt::format("cd '{}' && {} 2>&1", folder.string(), line).c_str(), "r");
  ShellResult result{.exit_code = -1, .output = {}};
  if (pipe == nullptr) return result;
  char buffer[4096];
  for (std::size_t got = fread(buffer, 1, sizeof buffer, pipe); got != 0;
       got = fread(buffer, 1, sizeof buffer, pipe)) {
    result.output.append(buffer, got);
  }
  result.exit_code = WEXITSTATUS(pclose(pipe));
  return result;
}

}  // namespace test_support
