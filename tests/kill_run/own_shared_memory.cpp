#include "tests/kill_run/own_shared_memory.hpp"

#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <string>

#include <fmt/format.h>

namespace kill_run {

namespace {

/// The same user and group in the new namespace as outside: files cannot be made by a user who is not in it.
bool keep_user(uid_t user, gid_t group) {
  const auto write = [](const char* file, const std::string& text) {
    std::ofstream out(file);
    out << text;
    return static_cast<bool>(out.flush());
  };
  return write("/proc/self/setgroups", "deny") &&
         write("/proc/self/uid_map", fmt::format("{0} {0} 1", user)) &&
         write("/proc/self/gid_map", fmt::format("{0} {0} 1", group));
}

bool enter() {
  const uid_t user = ::getuid();
  const gid_t group = ::getgid();
  if (::unshare(CLONE_NEWNS) != 0 &&
      (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0 || !keep_user(user, group))) {
    return false;
  }
  // Private first, or the mount would be seen outside.
  return ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("tmpfs", "/dev/shm", "tmpfs", MS_NOSUID | MS_NODEV, nullptr) == 0;
}

}  // namespace

bool enter_own_shared_memory() noexcept {
  // What fails half way cannot be undone: another process tries first.
  const pid_t trial = ::fork();
  if (trial == 0) ::_exit(enter() ? 0 : 1);
  int status = 0;
  if (trial < 0 || ::waitpid(trial, &status, 0) != trial || status != 0) return false;
  return enter();
}

}  // namespace kill_run
