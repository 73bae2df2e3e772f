// Variables that cycles share: each cycle owns one section of %M, which it sends at the end of a scan and all
// others find at the same addresses.
//
// Invariants
//   I1  what a cycle receives of another is the complete set of one of its sends, never parts of two.
//   I2  only the owner of a section changes it.
//   I3  all sections that a cycle takes over in one scan are the latest of one moment.
// Any thread; a call holds the lock for the time of a copy.
#pragma once

#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "emulator_models/soft_plc/inheriting_mutex.hpp"

namespace emulator_models::soft_plc {

class VariableExchange {
 public:
  /// All zero until something is sent.
  /// @param sections  what each cycle sends, in bytes of %M; within memory_bytes_max, without overlap
  explicit VariableExchange(std::vector<Section> sections);

  /// @param memory  the image of the cycle, which holds its section
  void send(std::size_t cycle, std::span<const std::byte> memory) noexcept;
  /// Takes over what all others have sent; what does not fit the image is left out.
  void receive(std::size_t cycle, std::span<std::byte> memory) const noexcept;

  /// Whether some byte of the section belongs to a cycle other than this one.
  [[nodiscard]] bool is_received(std::size_t cycle, const Section& section) const noexcept;

 private:
  const std::vector<Section> sections_;
  mutable InheritingMutex mutex_;
  std::vector<std::byte> sent_;  ///< guarded by mutex_
};

}  // namespace emulator_models::soft_plc
