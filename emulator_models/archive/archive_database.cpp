#include "emulator_models/archive/archive_database.hpp"

#include <algorithm>
#include <exception>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include "emulator_models/archive/archive_schema.hpp"

namespace emulator_models::archive {

namespace {

ArchiveErrorCode code_of(int result) noexcept {
  switch (result & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return ArchiveErrorCode::busy;
    case SQLITE_FULL:
      return ArchiveErrorCode::disk_full;
    case SQLITE_CORRUPT:
      return ArchiveErrorCode::damaged_file;
    case SQLITE_NOTADB:
      return ArchiveErrorCode::foreign_file;
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return ArchiveErrorCode::cannot_open;
    default:
      return ArchiveErrorCode::failed;
  }
}

const char* way_out(ArchiveErrorCode code) noexcept {
  switch (code) {
    case ArchiveErrorCode::limit_out_of_range:
      return "at least 1 row, 1 MiB for the file and 256 KiB for its WAL are needed";
    case ArchiveErrorCode::cannot_open:
      return "the folder must be there, and folder and file must be writable";
    case ArchiveErrorCode::foreign_file:
      return "it is left as it is; name another file, or move this one away";
    case ArchiveErrorCode::damaged_file:
      return "it is left as it is; move it away together with its -wal and -shm, and try sqlite3's .recover";
    case ArchiveErrorCode::busy:
      return "another process holds it, or reads an old state of it; it is tried again";
    case ArchiveErrorCode::disk_full:
      return "make room on the disk; it is tried again";
    case ArchiveErrorCode::failed:
      return "it is tried again";
  }
  return "";
}

}  // namespace

ArchiveDatabase::ArchiveDatabase(ArchiveDatabase&& other) noexcept
    : config_{std::move(other.config_)},
      database_{std::exchange(other.database_, nullptr)},
      insert_{std::exchange(other.insert_, nullptr)},
      power_up_{other.power_up_} {}

ArchiveDatabase::~ArchiveDatabase() {
  sqlite3_finalize(insert_);
  sqlite3_close(database_);
}

ArchiveError ArchiveDatabase::error(ArchiveErrorCode code, const std::string& text) const {
  return {code, fmt::format("archive {}: {}; {}", config_.file.string(), text, way_out(code))};
}

ArchiveError ArchiveDatabase::error() const {
  return error(code_of(sqlite3_extended_errcode(database_)), sqlite3_errmsg(database_));
}

bool ArchiveDatabase::execute(const char* sql) noexcept {
  return sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) == SQLITE_OK;
}

/// @return the first column of the first row; -1 when there is none, or an error
std::int64_t ArchiveDatabase::number(const char* sql) noexcept {
  sqlite3_stmt* statement = nullptr;
  std::int64_t result = -1;
  if (sqlite3_prepare_v2(database_, sql, -1, &statement, nullptr) == SQLITE_OK &&
      sqlite3_step(statement) == SQLITE_ROW) {
    result = sqlite3_column_int64(statement, 0);
  }
  sqlite3_finalize(statement);
  return result;
}

tl::expected<ArchiveDatabase, ArchiveError> ArchiveDatabase::open(const ArchiveConfig& config) noexcept try {
  ArchiveDatabase archive{config};
  if (config.rows_max < ArchiveConfig::rows_min || config.bytes_max < ArchiveConfig::bytes_min ||
      config.wal_bytes_max < ArchiveConfig::wal_bytes_min) {
    return tl::unexpected{archive.error(ArchiveErrorCode::limit_out_of_range, "a limit is too small")};
  }
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
  if (sqlite3_open_v2(config.file.c_str(), &archive.database_, flags, nullptr) != SQLITE_OK)
    return tl::unexpected{archive.error()};
  sqlite3_busy_timeout(archive.database_, static_cast<int>(busy_timeout.count()));
  if (auto checked = archive.check_identity(); !checked) return tl::unexpected{std::move(checked.error())};
  if (!archive.set_up(archive.number("PRAGMA application_id") == 0)) return tl::unexpected{archive.error()};
  return archive;
} catch (const std::exception& thrown) {
  return tl::unexpected{ArchiveError{ArchiveErrorCode::failed, thrown.what()}};
}

/// Reads only: nothing of a file that is refused is changed.
tl::expected<void, ArchiveError> ArchiveDatabase::check_identity() {
  const std::int64_t objects = number("SELECT count(*) FROM sqlite_schema");
  if (objects < 0) return tl::unexpected{error()};
  const std::int64_t id = number("PRAGMA application_id");
  if (objects == 0 && id == 0) return {};
  if (id != application_id) {
    return tl::unexpected{
        error(ArchiveErrorCode::foreign_file, "an SQLite file, but not an archive of a PLC")};
  }
  const std::int64_t version = number("PRAGMA user_version");
  if (version != schema_version) {
    return tl::unexpected{error(ArchiveErrorCode::foreign_file,
                                fmt::format("version {} of the archive, not {}", version, schema_version))};
  }
  if (number("SELECT quick_check = 'ok' FROM pragma_quick_check(1)") != 1)
    return tl::unexpected{error(ArchiveErrorCode::damaged_file, "damaged")};
  return {};
}

bool ArchiveDatabase::set_up(bool is_new) noexcept {
  // The limit of pages stands well above what make_room() keeps to: it is the last resort, not the rule.
  const std::int64_t pages_max = config_.bytes_max / page_bytes;
  if (is_new && !execute("PRAGMA page_size = 4096")) return false;
  if (!execute(
          fmt::format("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL; PRAGMA wal_autocheckpoint = 0;"
                      "PRAGMA journal_size_limit = {}; PRAGMA max_page_count = {}",
                      config_.wal_bytes_max, pages_max)
              .c_str())) {
    return false;
  }
  if (!execute("BEGIN IMMEDIATE")) return false;
  // Between the look and the lock another process may have made the file.
  if (is_new && number("PRAGMA application_id") == 0 &&
      (!execute(schema_sql) || !execute(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}",
                                                    application_id, schema_version)
                                            .c_str()))) {
    return false;
  }
  return begin_power_up() && execute("COMMIT") &&
         sqlite3_prepare_v3(database_, "INSERT INTO event VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)", -1,
                            SQLITE_PREPARE_PERSISTENT, &insert_, nullptr) == SQLITE_OK;
}

bool ArchiveDatabase::begin_power_up() noexcept {
  if (!execute("DELETE FROM power_up WHERE id NOT IN (SELECT power_up FROM event);"
               "DELETE FROM signal WHERE power_up NOT IN (SELECT id FROM power_up);"
               "DELETE FROM program WHERE power_up NOT IN (SELECT id FROM power_up)") ||
      !execute(
          fmt::format("INSERT INTO power_up VALUES ((SELECT max(coalesce((SELECT max(id) FROM power_up), 0),"
                      "coalesce((SELECT power_up FROM event ORDER BY id DESC LIMIT 1), 0)) + 1), {})",
                      config_.power_up_wall_clock.count())
              .c_str())) {
    return false;
  }
  power_up_ = sqlite3_last_insert_rowid(database_);
  return store_names("signal", config_.signal_names) && store_names("program", config_.program_files);
}

/// Of this power_up, by their order.
bool ArchiveDatabase::store_names(const char* table, const std::vector<std::string>& names) noexcept {
  for (std::size_t i = 0; i < names.size(); ++i) {
    char* const sql =
        sqlite3_mprintf("INSERT INTO %s VALUES (%lld, %lld, %Q)", table, static_cast<long long>(power_up_),
                        static_cast<long long>(i), names[i].c_str());
    const bool stored = sql != nullptr && execute(sql);
    sqlite3_free(sql);
    if (!stored) return false;
  }
  return true;
}

bool ArchiveDatabase::insert(const soft_plc::EventRecord& record) noexcept {
  int column = 0;
  for (const std::int64_t value :
       {power_up_, record.time_ns, static_cast<std::int64_t>(record.kind),
        static_cast<std::int64_t>(record.cycle), static_cast<std::int64_t>(record.code),
        static_cast<std::int64_t>(record.scan_number), record.values[0], record.values[1], record.values[2],
        record.values[3], record.values[4]}) {
    sqlite3_bind_int64(insert_, ++column, value);
  }
  const bool stored = sqlite3_step(insert_) == SQLITE_DONE;
  return sqlite3_reset(insert_) == SQLITE_OK && stored;
}

/// The oldest rows go: those beyond rows_max, and a tenth when the batch might not fit into the file.
bool ArchiveDatabase::make_room(std::size_t batch_rows) noexcept {
  const std::int64_t newest = std::max<std::int64_t>(number("SELECT max(id) FROM event"), 0);
  const std::int64_t oldest = std::max<std::int64_t>(number("SELECT min(id) FROM event"), 1);
  const auto batch = static_cast<std::int64_t>(batch_rows);
  std::int64_t keep_from = newest + batch - config_.rows_max + 1;
  const std::int64_t used =
      (number("PRAGMA page_count") - number("PRAGMA freelist_count")) * page_bytes + batch * row_bytes_max;
  if (used > config_.bytes_max - config_.bytes_max / 8)
    keep_from = std::max(keep_from, oldest + std::max((newest - oldest) / 10, batch));
  if (keep_from <= oldest) return true;
  return execute(fmt::format("DELETE FROM event WHERE id < {}", keep_from).c_str());
}

/// Moves the WAL into the file when it has grown to half of its bound, so that it starts again from its front.
tl::expected<void, ArchiveError> ArchiveDatabase::make_room_in_wal() {
  std::error_code failure;
  const auto bytes = [&] {
    return static_cast<std::int64_t>(std::filesystem::file_size(config_.file.string() + "-wal", failure));
  };
  // While it is open here the WAL is there, and nobody else removes it together with the file but by hand.
  const std::int64_t before = bytes();
  if (failure || !std::filesystem::exists(config_.file, failure))
    return tl::unexpected{
        error(ArchiveErrorCode::cannot_open,
              "it, or its -wal, was moved away or deleted while in use; put both back or start "
              "the PLC again")};
  if (before < config_.wal_bytes_max / 2) return {};
  // TRUNCATE: the size of the file tells how full it is. With a reader in an old state it fails, and that is told
  // only when the bound is reached.
  sqlite3_wal_checkpoint_v2(database_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  if (bytes() < config_.wal_bytes_max) return {};
  return tl::unexpected{
      error(ArchiveErrorCode::busy, "the WAL is full and a reader keeps it from starting again")};
}

std::size_t ArchiveDatabase::batch_rows_max() const noexcept {
  return static_cast<std::size_t>(std::min(config_.rows_max, config_.bytes_max / 4 * 3 / row_bytes_max));
}

tl::expected<std::size_t, ArchiveError> ArchiveDatabase::append(
    std::span<const soft_plc::EventRecord> batch) noexcept try {
  batch = batch.last(std::min(batch.size(), batch_rows_max()));
  if (auto room = make_room_in_wal(); !room) return tl::unexpected{std::move(room.error())};
  bool stored = execute("BEGIN IMMEDIATE") && make_room(batch.size());
  for (std::size_t i = 0; stored && i < batch.size(); ++i) stored = insert(batch[i]);
  if (stored && execute("COMMIT")) return batch.size();
  ArchiveError why = error();
  (void)execute("ROLLBACK");  // without effect when SQLite has already done it, or nothing was begun
  return tl::unexpected{std::move(why)};
} catch (const std::exception& thrown) {
  return tl::unexpected{ArchiveError{ArchiveErrorCode::failed, thrown.what()}};
}

}  // namespace emulator_models::archive
