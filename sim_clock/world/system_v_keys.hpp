// How shmget(2) and semget(2) find what a key leads to, and call what they make.
#pragma once

#include <sys/ipc.h>
#include <sys/types.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

/// Of a call that looks something up by its key, or removes it: to strategies one key is one name.
[[nodiscard]] inline Operation system_v_operation(OperationKind kind, World& world, key_t key) noexcept {
  return {.kind = kind, .name = world.scheduler().name_for_strategy([key] {
            return std::string_view{reinterpret_cast<const char*>(&key), sizeof key};
          })};
}

struct SystemVFound {
  int error = 0;                          ///< for errno; 0
  std::optional<std::size_t> index = {};  ///< none, and no error: it is to be made
};

/// @param all    with members `key` and `removed`
/// @param flags  IPC_CREAT, IPC_EXCL
template <typename Entry>
[[nodiscard]] SystemVFound find_by_key(const std::vector<Entry>& all, key_t key, int flags) noexcept {
  if (key == IPC_PRIVATE) return {};
  const auto found = std::find_if(all.begin(), all.end(),
                                  [key](const Entry& each) { return each.key == key && !each.removed; });
  if (found == all.end()) return {.error = (flags & IPC_CREAT) == 0 ? ENOENT : 0};
  if ((flags & IPC_CREAT) != 0 && (flags & IPC_EXCL) != 0) return {.error = EEXIST};
  return {.index = static_cast<std::size_t>(found - all.begin())};
}

/// How messages call it: "shm-0x4c54", and without a key "shm-private-1".
/// @param all  those that were made before
template <typename Entry>
[[nodiscard]] std::string name_by_key(std::string_view what, const std::vector<Entry>& all, key_t key) {
  if (key != IPC_PRIVATE) return fmt::format("{}-{:#x}", what, static_cast<unsigned>(key));
  const auto before =
      std::count_if(all.begin(), all.end(), [](const Entry& each) { return each.key == IPC_PRIVATE; });
  return fmt::format("{}-private-{}", what, before + 1);
}

}  // namespace ltsim
