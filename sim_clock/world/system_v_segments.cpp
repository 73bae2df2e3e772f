#include "sim_clock/world/system_v_segments.hpp"

#include <cerrno>

#include <fmt/format.h>

#include "sim_clock/world/state_hash.hpp"
#include "sim_clock/world/system_v_keys.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
int SystemVSegments::get(key_t key, std::size_t bytes, int flags) {
  world_.scheduler().point(system_v_operation(OperationKind::shm_open, world_, key));
  const GhostScope ghost;
  const SystemVFound found = find_by_key(entries_, key, flags);
  const bool fits = found.index ? bytes <= entries_[*found.index].bytes : bytes != 0;
  if (found.error != 0 || !fits) {
    errno = found.error != 0 ? found.error : EINVAL;
    return -1;
  }
  if (found.index) {
    world_.scheduler().only_looked();
    return static_cast<int>(*found.index);
  }
  const std::string name = name_by_key("shm", entries_, key);
  entries_.push_back({.key = key, .segment = world_.segments().create_unnamed(name, bytes), .bytes = bytes});
  return static_cast<int>(entries_.size() - 1);
}

void* SystemVSegments::attach(int id, const void* address, int flags) {
  void* const failed = reinterpret_cast<void*>(-1);  // shmat(2)
  world_.scheduler().point({.kind = OperationKind::shm_map});
  const Entry* const entry = find(id);
  if (entry == nullptr) return failed;
  if (address != nullptr || (flags & SHM_REMAP) != 0) {
    const GhostScope ghost;
    world_.unsupported("shmat to an address of the program's own choice");
    return failed;
  }
  return world_.segments().attach(entry->segment, entry->bytes, (flags & SHM_RDONLY) == 0);
}

int SystemVSegments::detach(const void* address) {
  world_.scheduler().point({.kind = OperationKind::shm_unmap});
  return world_.segments().detach(address);
}

int SystemVSegments::control(int id, int command, shmid_ds* buffer) {
  const Entry* const named = find(id);
  if (named == nullptr) return -1;
  world_.scheduler().point(system_v_operation(
      command == IPC_STAT ? OperationKind::shm_status : OperationKind::shm_unlink, world_, named->key));
  Entry* const entry = find(id);  // it may have gone meanwhile
  if (entry == nullptr) return -1;
  switch (command) {
    case IPC_RMID:
      entry->removed = true;
      return 0;
    case IPC_STAT:
      *buffer = {};
      buffer->shm_perm.__key = entry->removed ? IPC_PRIVATE : entry->key;
      buffer->shm_perm.mode = static_cast<unsigned short>(0600U | (entry->removed ? unsigned{SHM_DEST} : 0U));
      buffer->shm_segsz = entry->bytes;
      buffer->shm_nattch = world_.segments().mappings_of(entry->segment);
      return 0;
    case IPC_SET:
      return 0;  // the simulated world has one user
    default: {
      const GhostScope ghost;
      world_.unsupported(fmt::format("shmctl with command {}", command));
      return -1;
    }
  }
}

bool SystemVSegments::is_gone(const Entry& entry) const noexcept {
  return entry.removed && world_.segments().mappings_of(entry.segment) == 0;
}

SystemVSegments::Entry* SystemVSegments::find(int id) {
  const auto index = static_cast<std::size_t>(id);
  if (id < 0 || index >= entries_.size() || is_gone(entries_[index])) {
    errno = EINVAL;
    return nullptr;
  }
  return &entries_[index];
}

void SystemVSegments::add_state(StateHash& hash) const noexcept {
  hash.add(entries_.size());
  for (const Entry& entry : entries_)
    hash.add(std::uint64_t{entry.segment} << 1U | std::uint64_t{entry.removed});
}

}  // namespace ltsim
