// The state word of the hardened handoff: its coding, and what an attach makes of it.
//
//   bits 0-2    phase        who owns the areas
//   bits 3-15   generation   +1 at each attach, modulo 2^13
//   bits 16-31  sequence     the low 16 bits of the request's sequence number
//
// Zero is RAW, which is what fresh shared memory contains. Each 32-bit value is a state word: three bits name eight
// phases, so decoding cannot fail.
//
//   phase         meaning                                            owner of both areas
//   raw       0   not initialised                                    nobody
//   idle      1   free                                               master
//   request   2   published, not taken                               nobody
//   busy      3   taken                                              slave
//   response  4   answered                                           master
//   orphan    5   taken, but the master has given up                 slave
//   lost      6   a slave died in busy; the master must acknowledge  master
//   down      7   no slave serves, in good order                     nobody
//
// Invariants
//   A move other than an attach keeps the generation; only publishing changes the sequence.
//   An attach advances the generation by one, or changes nothing; no request is left to be taken after it.
// Not here: how the word changes in shared memory (state_cell.hpp), and who may make which move when (master.hpp,
// slave.hpp).
#pragma once

#include <cstdint>

namespace protocol::hardened {

enum class Phase : std::uint8_t { raw, idle, request, busy, response, orphan, lost, down };

struct StateWord {
  static constexpr unsigned generation_bits = 13;
  static constexpr std::uint16_t generation_max = (1U << generation_bits) - 1;

  Phase phase = Phase::raw;
  std::uint16_t generation = 0;  ///< 0 to generation_max
  std::uint16_t sequence = 0;

  bool operator==(const StateWord&) const = default;

  /// The same request in the same generation, in another phase.
  [[nodiscard]] constexpr StateWord in(Phase next) const noexcept { return {next, generation, sequence}; }
  /// Another request, published in the same generation.
  /// @param number  sequence number of the request; its low 16 bits count
  [[nodiscard]] constexpr StateWord publishing(std::uint64_t number) const noexcept {
    return {Phase::request, generation, static_cast<std::uint16_t>(number)};
  }
  /// What an attach makes of it.
  [[nodiscard]] constexpr StateWord in_next_generation(Phase next) const noexcept {
    return {next, static_cast<std::uint16_t>((generation + 1U) & generation_max), sequence};
  }
};

[[nodiscard]] constexpr std::uint32_t encode(const StateWord& word) noexcept {
  return static_cast<std::uint32_t>(word.phase) | std::uint32_t{word.generation} << 3U |
         std::uint32_t{word.sequence} << 16U;
}

[[nodiscard]] constexpr StateWord decode(std::uint32_t word) noexcept {
  return {static_cast<Phase>(word & 7U), static_cast<std::uint16_t>(word >> 3U & StateWord::generation_max),
          static_cast<std::uint16_t>(word >> 16U)};
}

/// What the word becomes when a slave attaches. A request that nobody has taken is dropped; one that the slave before
/// had in its hands is lost; an answer that it gave stays.
[[nodiscard]] constexpr StateWord after_slave_attach(const StateWord& word) noexcept {
  switch (word.phase) {
    case Phase::busy:
    case Phase::lost:
      return word.in_next_generation(Phase::lost);
    case Phase::response:
      return word.in_next_generation(Phase::response);
    case Phase::raw:
    case Phase::idle:
    case Phase::request:
    case Phase::orphan:
    case Phase::down:
      break;
  }
  return word.in_next_generation(Phase::idle);
}

/// What the word becomes when a master attaches. Whatever the master before had asked for ends here; what the slave
/// has in its hands, it finishes for nobody. Without a slave nothing changes.
[[nodiscard]] constexpr StateWord after_master_attach(const StateWord& word) noexcept {
  switch (word.phase) {
    case Phase::raw:
    case Phase::down:
      return word;
    case Phase::busy:
    case Phase::orphan:
      return word.in_next_generation(Phase::orphan);
    case Phase::idle:
    case Phase::request:
    case Phase::response:
    case Phase::lost:
      break;
  }
  return word.in_next_generation(Phase::idle);
}

}  // namespace protocol::hardened
