// What a run leaves to chance. A seed fixes the draws, not the run: the processes are real, and the system schedules them.
#pragma once

#include <cmath>
#include <cstdint>

namespace kill_run {

/// SplitMix64: the next of a row of numbers without visible pattern. Also turns a number into another at random.
[[nodiscard]] constexpr std::uint64_t mix(std::uint64_t number) noexcept {
  number += 0x9E37'79B9'7F4A'7C15U;
  number = (number ^ number >> 30U) * 0xBF58'476D'1CE4'E5B9U;
  number = (number ^ number >> 27U) * 0x94D0'49BB'1331'11EBU;
  return number ^ number >> 31U;
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) noexcept : state_(mix(seed)) {}

  [[nodiscard]] std::uint64_t number() noexcept { return mix(state_++); }
  /// @param count  at least 1
  /// @return       0 to count - 1
  [[nodiscard]] std::uint64_t below(std::uint64_t count) noexcept { return number() % count; }
  [[nodiscard]] bool one_in(std::uint64_t count) noexcept { return below(count) == 0; }
  /// Each order of magnitude is as likely as any other.
  /// @param least  at least 1
  [[nodiscard]] std::uint64_t log_uniform(std::uint64_t least, std::uint64_t most) noexcept {
    constexpr double scale = 1.0 / 18'446'744'073'709'551'616.0;  // 2^-64
    const double share = static_cast<double>(number()) * scale;
    const double ratio = static_cast<double>(most) / static_cast<double>(least);
    return static_cast<std::uint64_t>(static_cast<double>(least) * std::pow(ratio, share));
  }

 private:
  std::uint64_t state_;
};

}  // namespace kill_run
