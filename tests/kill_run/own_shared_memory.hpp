// A /dev/shm that no other program sees.
#pragma once

namespace kill_run {

/// Gives this process, which must have one thread, and those that it forks an empty /dev/shm, until they end: named
/// objects that turn up there are theirs, whatever they are called.
/// @return whether the system let it, which it does for root, and mostly for users; otherwise all is as it was
[[nodiscard]] bool enter_own_shared_memory() noexcept;

}  // namespace kill_run
