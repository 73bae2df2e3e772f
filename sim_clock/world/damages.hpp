// Damage to shared memory: a bit that flips, a byte that is written by somebody who has no business there.
//
// Granted for bytes of a segment, it strikes at an access to the segment, before the access itself. The way in
// which it strikes is the bit or the byte: the same number in every run, whatever the build.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/world/fault_kind.hpp"

namespace ltsim {

class StateHash;
class World;

class Damages {
 public:
  explicit Damages(World& world) noexcept : world_(world) {}
  void reset() noexcept;

  /// @param kind   bit_flip or foreign_write
  /// @param times  in an execution
  void grant(FaultKind kind, std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
             unsigned times);

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  [[nodiscard]] bool are_possible() const noexcept { return left_ != 0; }
  /// Asks whether the segment is damaged here, and damages it.
  /// @param memory  all its bytes
  void choose(std::string_view segment, std::span<std::byte> memory) noexcept;

 private:
  struct Grant {
    FaultKind kind;
    std::string segment;
    std::uint32_t offset;
    std::uint32_t bytes;
    unsigned left;
  };

  void choose(FaultKind kind, std::string_view segment, std::span<std::byte> memory) noexcept;
  void strike(Grant& grant, std::span<std::byte> memory, std::size_t way) noexcept;

  World& world_;
  unsigned left_ = 0;  // of all grants together
  std::vector<Grant> grants_;
};

}  // namespace ltsim
