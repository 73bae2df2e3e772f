#include "protocol/role_lock.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace protocol {

namespace {

std::string lock_path(std::string_view segment_name, Role role) {
  std::string path = "/tmp/ltsim-";
  path += segment_name;
  std::replace(path.begin() + sizeof("/tmp/") - 1, path.end(), '/', '_');
  path += '.';
  path += to_string(role);
  path += ".lock";
  return path;
}

struct flock whole_file() noexcept {
  struct flock lock = {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

/// Two steps, since Linux refuses O_CREAT on another user's file in a sticky folder (fs.protected_regular).
int open_or_create(const char* path) noexcept {
  constexpr int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW;
  for (;;) {
    int descriptor = ::open(path, flags);
    if (descriptor >= 0 || errno != ENOENT) return descriptor;
    constexpr mode_t everybody = 0666;
    descriptor = ::open(path, flags | O_CREAT | O_EXCL, everybody);
    if (descriptor >= 0)
      ::fchmod(descriptor, everybody);  // another user may take the role next; umask or not
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
}

/// The file may have been removed, and even made again, between opening and locking it.
bool leads_to(const char* path, int descriptor) noexcept {
  struct stat named = {};
  struct stat opened = {};
  return ::stat(path, &named) == 0 && ::fstat(descriptor, &opened) == 0 && named.st_dev == opened.st_dev &&
         named.st_ino == opened.st_ino;
}

}  // namespace

std::string_view to_string(Role role) noexcept { return role == Role::kernel ? "kernel" : "emulator"; }

std::string_view to_string(RoleLockError error) noexcept {
  switch (error) {
    case RoleLockError::held_by_other:
      return "the role is held by another process";
    case RoleLockError::cannot_open:
      return "the lock file cannot be opened";
  }
  return "unknown role lock error";
}

RoleLock::RoleLock(std::string_view segment_name, Role role) : path_(lock_path(segment_name, role)) {}

RoleLock::~RoleLock() { release(); }

tl::expected<void, RoleLockError> RoleLock::try_lock() noexcept {
  while (!is_held()) {
    const int descriptor = open_or_create(path_.c_str());
    if (descriptor < 0) return tl::unexpected(RoleLockError::cannot_open);
    struct flock lock = whole_file();
    if (::fcntl(descriptor, F_OFD_SETLK, &lock) != 0) {
      const bool held = errno == EAGAIN || errno == EACCES;
      ::close(descriptor);
      return tl::unexpected(held ? RoleLockError::held_by_other : RoleLockError::cannot_open);
    }
    if (leads_to(path_.c_str(), descriptor))
      descriptor_ = descriptor;
    else
      ::close(descriptor);
  }
  return {};
}

void RoleLock::release() noexcept {
  if (!is_held()) return;
  ::unlink(path_.c_str());
  ::close(std::exchange(descriptor_, -1));
}

bool RoleLock::is_held() const noexcept { return descriptor_ >= 0; }

bool RoleLock::is_held_by_other() const noexcept {
  if (is_held()) return false;
  const int descriptor = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  struct flock lock = whole_file();
  const bool held = ::fcntl(descriptor, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
  ::close(descriptor);
  return held;
}

}  // namespace protocol
