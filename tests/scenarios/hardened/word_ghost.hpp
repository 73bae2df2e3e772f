// What the state word of the hardened handoff is if each of its changes is one step of the table (I14).
//
// The table is written down here a second time, from the protocol's description and not from its code: who may put
// which phase in the place of which. An attach is what changes the generation, by +1; nothing else changes it. The
// sequence changes where a request is published, and nowhere else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace scenarios {

class HardenedWordGhost {
 public:
  enum Phase : std::uint32_t { raw, idle, request, busy, response, orphan, lost, down };
  enum class Mover : std::uint8_t { master, slave };

  /// @param word  what is in the segment when the world begins
  explicit HardenedWordGhost(std::uint32_t word) noexcept : word_(word) {}

  /// The mover says that it has put one word in the place of another.
  /// @return what is wrong with that, if something is
  std::optional<std::string> moves(Mover mover, std::uint32_t from, std::uint32_t to);

  [[nodiscard]] std::uint32_t word() const noexcept { return word_; }
  [[nodiscard]] Phase phase() const noexcept { return phase_of(word_); }
  [[nodiscard]] std::uint32_t generation() const noexcept { return generation_of(word_); }

  [[nodiscard]] static Phase phase_of(std::uint32_t word) noexcept { return static_cast<Phase>(word % 8); }
  [[nodiscard]] static std::uint32_t generation_of(std::uint32_t word) noexcept { return word / 8 % 8192; }
  [[nodiscard]] static std::uint32_t sequence_of(std::uint32_t word) noexcept { return word / 65536; }

 private:
  std::uint32_t word_;
};

}  // namespace scenarios
