// System V shared memory of the simulated world: shmget(2) and its kind, on the segments that POSIX objects have, too.
//
// A segment has no name but its key, as ipcs(1) prints it: "shm-0x4c54", and without a key "shm-private-1". It lies where POSIX objects do,
// is accessed as they are, and counts among the most that there can be (Segments::segments_max).
#pragma once

#include <sys/shm.h>
#include <sys/types.h>

#include <cstddef>
#include <vector>

namespace ltsim {

class StateHash;
class World;

class SystemVSegments {
 public:
  explicit SystemVSegments(World& world) noexcept : world_(world) {}
  void reset() noexcept { entries_.clear(); }

  // The calls, for the running task; errors as Linux's manual pages list them, in errno.
  int get(key_t key, std::size_t bytes, int flags);
  /// @param address  where it shall be; only null is simulated
  void* attach(int id, const void* address, int flags);
  int detach(const void* address);
  /// IPC_RMID, IPC_STAT and IPC_SET.
  int control(int id, int command, shmid_ds* buffer);

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;

 private:
  struct Entry {
    key_t key = IPC_PRIVATE;
    std::size_t segment = 0;  ///< of Segments
    std::size_t bytes = 0;
    bool removed =
        false;  ///< it goes when nobody has it attached any more; until then its identifier, not its key, finds it
  };

  /// @return null, with EINVAL in errno, if there is none
  [[nodiscard]] Entry* find(int id);
  [[nodiscard]] bool is_gone(const Entry& entry) const noexcept;

  World& world_;
  std::vector<Entry> entries_;  // by identifier
};

}  // namespace ltsim
