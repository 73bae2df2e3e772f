// An archive in a folder of the test's own, and a second connection that looks into it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "emulator_models/archive/archive_database.hpp"
#include "tests/support/shell.hpp"

namespace emulator_models::archive {

inline soft_plc::EventRecord numbered(std::uint64_t number) {
  return {.kind = soft_plc::EventKind::overrun,
          .time_ns = static_cast<std::int64_t>(number) * 1'000'000,
          .scan_number = number,
          .values = {static_cast<std::int64_t>(number)}};
}

inline std::vector<soft_plc::EventRecord> numbered_from(std::uint64_t first, std::uint64_t count) {
  std::vector<soft_plc::EventRecord> records;
  for (std::uint64_t i = 0; i < count; ++i) records.push_back(numbered(first + i));
  return records;
}

/// Somebody else who has the file open.
class OtherConnection {
 public:
  explicit OtherConnection(const std::filesystem::path& file) { sqlite3_open(file.c_str(), &database_); }
  OtherConnection(const OtherConnection&) = delete;
  OtherConnection& operator=(const OtherConnection&) = delete;
  ~OtherConnection() { sqlite3_close(database_); }

  /// @return all values, each followed by a space; or what SQLite says of the error
  std::string operator()(const std::string& sql) {
    std::string text;
    const auto add = [](void* into, int columns, char** values, char**) {
      for (int i = 0; i < columns; ++i)
        static_cast<std::string*>(into)->append(values[i] != nullptr ? values[i] : "").append(" ");
      return 0;
    };
    if (sqlite3_exec(database_, sql.c_str(), add, &text, nullptr) != SQLITE_OK)
      text = sqlite3_errmsg(database_);
    return text;
  }

 private:
  sqlite3* database_ = nullptr;
};

class ArchiveTest : public testing::Test {
 protected:
  std::string query(const std::string& sql) { return OtherConnection{config.file}(sql); }
  std::int64_t bytes_of_file_and_wal() {
    return static_cast<std::int64_t>(std::filesystem::file_size(config.file) +
                                     std::filesystem::file_size(config.file.string() + "-wal"));
  }

  test_support::TemporaryFolder folder;
  ArchiveConfig config{.file = folder.path() / "plc.archive"};
};

}  // namespace emulator_models::archive
