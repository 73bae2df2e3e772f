// The one source of chance: xoshiro256++ 1.0, seeded by splitmix64.
//
// Source: David Blackman and Sebastiano Vigna, "Scrambled linear pseudorandom number generators" (2021),
// whose public reference values the test repeats. No std::*_distribution: libraries differ in them, and a
// schedule must not.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace ltsim {

/// One step of splitmix64: a good 64-bit hash of `x`, and the next seed of a sequence when `x` counts up.
[[nodiscard]] constexpr std::uint64_t splitmix64(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

class RandomGenerator {
 public:
  explicit constexpr RandomGenerator(std::uint64_t seed) noexcept {
    for (std::uint64_t i = 0; i < state_.size(); ++i) state_[i] = splitmix64(seed + i * 0x9e3779b97f4a7c15U);
  }

  /// Starts from the four state words themselves; not all of them zero.
  explicit constexpr RandomGenerator(const std::array<std::uint64_t, 4>& state) noexcept : state_(state) {}

  constexpr std::uint64_t next() noexcept {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17U;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// `count` random bits, 1 to 32, as a number; one next() lasts for as many of them as it holds.
  constexpr std::uint32_t bits(unsigned count) noexcept {
    if (reserve_bits_count_ < count) {
      reserve_ = next();
      reserve_bits_count_ = 64;
    }
    const auto drawn = static_cast<std::uint32_t>(reserve_ & ((std::uint64_t{1} << count) - 1));
    reserve_ >>= count;
    reserve_bits_count_ -= count;
    return drawn;
  }

  /// Uniform in [0, bound), without bias. bound >= 1.
  /// Source: Daniel Lemire, "Fast random integer generation in an interval" (2019).
  constexpr std::uint32_t below(std::uint32_t bound) noexcept {
    std::uint64_t product = (next() >> 32U) * bound;
    if (static_cast<std::uint32_t>(product) < bound) [[unlikely]] {
      const std::uint32_t threshold = -bound % bound;
      while (static_cast<std::uint32_t>(product) < threshold) product = (next() >> 32U) * bound;
    }
    return static_cast<std::uint32_t>(product >> 32U);
  }

 private:
  std::array<std::uint64_t, 4> state_{};
  std::uint64_t reserve_ = 0;
  unsigned reserve_bits_count_ = 0;
};

}  // namespace ltsim
