// Where in an execution something is to happen that can happen on many occasions: k places drawn uniformly
// from as many occasions as executions before had.
//
// The number of occasions is learned: a long execution raises the estimate at once, shorter ones lower it
// slowly. Places beyond the end of an execution are lost, so a part of the draws is made log-uniformly: near
// the begin something happens in every execution, however short.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "sim_clock/explore/random_generator.hpp"

namespace ltsim {

class Occasions {
 public:
  static constexpr std::size_t places_max = 8;

  /// Draws the places of an execution.
  /// @param places_count  0 to places_max
  void begin(RandomGenerator& generator, std::size_t places_count) noexcept {
    passed_ = 0;
    places_count_ = places_count;
    for (std::size_t i = 0; i < places_count; ++i) {
      const bool log_uniform = generator.below(4) == 0;
      places_[i] = generator.below(log_uniform ? std::uint32_t{1} << generator.below(order_of_magnitude() + 1)
                                               : estimate());
    }
    std::sort(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(places_count));
    next_ = 0;
  }

  /// The next occasion. @return how many of the places it is
  [[nodiscard]] std::size_t pass() noexcept {
    const std::uint64_t occasion = passed_++;
    std::size_t hits = 0;
    for (; next_ < places_count_ && places_[next_] <= occasion; ++next_) ++hits;
    return hits;
  }

  /// Occasions of this execution so far.
  [[nodiscard]] std::uint64_t passed() const noexcept { return passed_; }

  [[nodiscard]] bool any_hit() const noexcept { return next_ != 0; }

  /// The execution has ended and counts.
  /// @param seen_all  false: there may have been more occasions than were passed, so the estimate is not lowered
  void learn(bool seen_all = true) noexcept {
    constexpr std::uint64_t most = std::uint64_t{1} << 30U;
    const std::uint64_t seen = std::clamp(passed_, std::uint64_t{1}, most) * parts;
    const std::uint64_t kept = seen_all ? parts_estimated_ - parts_estimated_ / parts : parts_estimated_;
    parts_estimated_ = is_learned_ ? std::max(seen, kept) : seen;
    is_learned_ = true;
  }

  /// Occasions to expect in an execution, at least 1.
  [[nodiscard]] std::uint32_t estimate() const noexcept {
    return static_cast<std::uint32_t>((parts_estimated_ + parts - 1) / parts);
  }

 private:
  [[nodiscard]] std::uint32_t order_of_magnitude() const noexcept {
    return static_cast<std::uint32_t>(std::bit_width(estimate())) - 1;
  }

  static constexpr std::uint64_t parts = 16;  // of an occasion: so that small numbers, too, fall slowly
  static constexpr std::uint32_t first_estimate = 64;

  std::uint64_t parts_estimated_ = first_estimate * parts;
  bool is_learned_ = false;
  std::uint64_t passed_ = 0;
  std::array<std::uint64_t, places_max> places_{};
  std::size_t places_count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace ltsim
