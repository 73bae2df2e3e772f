// Bytes of segments that nobody may read before somebody has written them.
//
// A new segment holds zeros, so such a read is not undefined, and it may be meant: a word that is polled for a change is not to
// be declared. What World::leave_segment() puts there was written by nobody in this life.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/world/operation.hpp"

namespace ltsim {

class StateHash;
class World;
struct Task;

class WrittenFirst {
 public:
  explicit WrittenFirst(World& world) noexcept : world_(world) {}
  void reset() noexcept { regions_count_ = 0; }

  /// See World::written_first().
  void declare(std::string_view segment, std::uint32_t offset, std::uint32_t bytes, std::string_view name);

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  /// The running task performs `operation` next. Ends the execution if that reads what nobody has written.
  void performs(const Task& task, const Operation& operation) noexcept;

 private:
  struct Region {
    std::string segment;
    std::uint32_t offset = 0;
    std::string name;
    std::vector<bool> written;  // by byte of the region
  };

  World& world_;
  std::vector<Region> regions_;  // pooled; the first regions_count_ belong to this execution
  std::size_t regions_count_ = 0;
};

}  // namespace ltsim
