// The archive file: a ring of event rows in SQLite, bounded in rows and bytes.
//
// WAL mode, synchronous = NORMAL: a committed batch survives the end of the process by any signal. A loss of power
// can take the batches since the last checkpoint, never the file's integrity.
//
// Invariants
//   I1  append() stores all records of a batch or none; of a batch that is longer than the archive the newest.
//   I2  after an append() the file holds at most rows_max events, the newest; older ones make room.
//   I3  the file and its WAL together take at most bytes_max + wal_bytes_max + batch_bytes() of the latest batch; the
//       index of the WAL, -shm, 1/128 of its length in addition. When a reader holds on to an old state so that the
//       WAL cannot start again, append() refuses.
//   I4  a file that is no archive, is damaged or of another version is refused and left as it is; one that is moved
//       away or deleted while in use is not written any more.
// One thread at a time.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/event_record.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace emulator_models::archive {

struct ArchiveConfig {
  static constexpr std::int64_t rows_min = 1;
  static constexpr std::int64_t bytes_min = 1 << 20;
  static constexpr std::int64_t wal_bytes_min = 1 << 18;

  std::filesystem::path file;
  std::int64_t rows_max = 1'000'000;
  std::int64_t bytes_max = std::int64_t{128} << 20;
  std::int64_t wal_bytes_max = std::int64_t{4} << 20;
  std::chrono::nanoseconds power_up_wall_clock{0};  ///< since 1970; times of records count from it
  std::vector<std::string> signal_names{};          ///< by number
  std::vector<std::string> program_files{};         ///< by cycle; places of faults are in them
};

enum class ArchiveErrorCode : std::uint8_t {
  limit_out_of_range,  ///< a bound of the configuration
  cannot_open,         ///< missing folder, no right to write, moved away while in use
  foreign_file,        ///< a file of something else, or of another version of the archive
  damaged_file,
  busy,  ///< another process holds it, or a reader holds on to an old state: later
  disk_full,
  failed,  ///< any other failure of the disk or of SQLite
};
inline constexpr std::size_t archive_error_codes_count = 7;

struct ArchiveError {
  ArchiveErrorCode code;
  std::string message;  ///< names the file, what is wrong and the way out
};

class ArchiveDatabase {
 public:
  static constexpr std::chrono::milliseconds busy_timeout{100};

  /// Opens or creates the file, checks it whole, and begins a new power_up in it.
  [[nodiscard]] static tl::expected<ArchiveDatabase, ArchiveError> open(const ArchiveConfig& config) noexcept;

  ArchiveDatabase(ArchiveDatabase&& other) noexcept;
  ArchiveDatabase& operator=(ArchiveDatabase&&) = delete;
  ~ArchiveDatabase();

  /// What a batch adds to the WAL at most, in bytes: its rows, and the pages touched by it and by what makes room.
  [[nodiscard]] static constexpr std::int64_t batch_bytes(std::size_t rows) noexcept {
    return static_cast<std::int64_t>(rows) * row_bytes_max + 64 * page_bytes;
  }

  /// One transaction. After an error nothing of the batch is stored, and it can be tried again.
  /// @return rows stored, the last of the batch: all, unless it is longer than rows_max or than 3/4 of bytes_max
  [[nodiscard]] tl::expected<std::size_t, ArchiveError> append(
      std::span<const soft_plc::EventRecord> batch) noexcept;

 private:
  static constexpr std::int64_t page_bytes = 4096;
  /// A row takes at most this, with its share of the tree: 12 numbers of up to 9 bytes.
  static constexpr std::int64_t row_bytes_max = 160;

  explicit ArchiveDatabase(const ArchiveConfig& config) : config_{config} {}

  [[nodiscard]] bool execute(const char* sql) noexcept;
  [[nodiscard]] std::int64_t number(const char* sql) noexcept;
  [[nodiscard]] ArchiveError error() const;
  [[nodiscard]] ArchiveError error(ArchiveErrorCode code, const std::string& text) const;
  [[nodiscard]] tl::expected<void, ArchiveError> check_identity();
  [[nodiscard]] bool set_up(bool is_new) noexcept;
  [[nodiscard]] bool begin_power_up() noexcept;
  [[nodiscard]] bool store_names(const char* table, const std::vector<std::string>& names) noexcept;
  [[nodiscard]] bool insert(const soft_plc::EventRecord& record) noexcept;
  [[nodiscard]] bool make_room(std::size_t batch_rows) noexcept;
  [[nodiscard]] std::size_t batch_rows_max() const noexcept;
  [[nodiscard]] tl::expected<void, ArchiveError> make_room_in_wal();

  ArchiveConfig config_;
  sqlite3* database_ = nullptr;
  sqlite3_stmt* insert_ = nullptr;
  std::int64_t power_up_ = 0;
};

}  // namespace emulator_models::archive
