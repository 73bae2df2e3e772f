// A disk whose writes fail, for all of SQLite: stands in for pwrite(2) of its Unix file system.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cerrno>

#include <sqlite3.h>

namespace emulator_models::archive {

class FailingDisk {
 public:
  FailingDisk() noexcept { set(reinterpret_cast<sqlite3_syscall_ptr>(&write_or_fail)); }
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;
  ~FailingDisk() {
    set(nullptr);  // the one of the system again
    fail_from(-1, 0);
  }

  /// @param write  number of the first write that fails, from 0 on; -1: none
  /// @param error  an errno
  /// @param for_good  else only that one
  static void fail_from(int write, int error, bool for_good = true) noexcept {
    writes_ = 0;
    first_ = write;
    error_ = error;
    for_good_ = for_good;
  }
  /// @return writes since fail_from
  static int writes() noexcept { return writes_; }

 private:
  static ssize_t write_or_fail(int file, const void* bytes, size_t count, off_t offset) {
    const int write = writes_++;
    if (first_ < 0 || write < first_ || (write > first_ && !for_good_))
      return pwrite(file, bytes, count, offset);
    errno = error_;
    return -1;
  }
  static void set(sqlite3_syscall_ptr call) noexcept {
    sqlite3_vfs* const vfs = sqlite3_vfs_find(nullptr);
    for (const char* const name : {"pwrite", "pwrite64"}) vfs->xSetSystemCall(vfs, name, call);
  }

  static inline int writes_ = 0;
  static inline int first_ = -1;
  static inline int error_ = 0;
  static inline bool for_good_ = true;
};

}  // namespace emulator_models::archive
