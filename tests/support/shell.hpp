// Runs programs as a user does, from a shell, in a folder of the test's own.
#pragma once

#include <filesystem>
#include <string>

namespace test_support {

/// An empty folder, removed with all it holds when the object goes.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  std::filesystem::path path_;
};

struct ShellResult {
  int exit_code;
  std::string output;  ///< both streams
};

/// Runs one line in `folder`.
ShellResult run_in(const std::filesystem::path& folder, const std::string& line);

}  // namespace test_support
