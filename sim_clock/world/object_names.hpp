// Names of the things that tasks act on, for schedules, traces and messages.
//
// A schedule anchors its lines to these names, so they must not depend on addresses or on the build: a
// semaphore and a segment go by the name they were opened with, a semaphore that begins a segment by the
// segment's, a region of a segment by the name the scenario gave it, a mutex by the order of first use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/world/operation.hpp"

namespace ltsim {

/// Makes of a name what schedules can hold: one word. Blanks become '_', nothing becomes "_".
void make_one_word(std::string& name);

class ProgramMemory;

class ObjectNames {
 public:
  /// @param program_memory  names its own objects; outlives this
  explicit ObjectNames(const ProgramMemory& program_memory) noexcept : program_memory_(program_memory) {}
  void reset() noexcept;

  /// @param name  a leading '/' (POSIX names) is left out, blanks become '_': a name is one word of a
  /// schedule
  ObjectId add(std::string_view name);

  /// Gives bytes of a segment a name of their own; it may be opened later.
  /// @param object_name  the segment's name, without '/'
  void name_region(std::string_view object_name, std::uint32_t offset, std::uint32_t bytes,
                   std::string_view region);

  /// What the operation acts on: the region or the object; "memory" for atomics outside a segment; "-" for
  /// none.
  [[nodiscard]] std::string name(const Operation& operation) const;
  /// The same with the byte within the region, for memory accesses: "segment.request[3]".
  [[nodiscard]] std::string place(const Operation& operation) const;
  [[nodiscard]] std::string_view object_name(ObjectId object) const noexcept;

 private:
  struct Region {
    std::string object_name;
    std::uint32_t offset;
    std::uint32_t bytes;
    std::string name;
  };

  [[nodiscard]] const Region* region_of(const Operation& operation) const noexcept;

  const ProgramMemory& program_memory_;
  std::vector<std::string> names_;  // pooled; index = ObjectId - 1
  std::size_t names_count_ = 0;
  std::vector<Region> regions_;
  std::size_t regions_count_ = 0;
};

}  // namespace ltsim
