// Changes to bytes that are records of BytesStrategy, for a fuzzing engine: by whole records and fields, so that most of what
// comes out decides something else than what went in.
#pragma once

#include <cstddef>
#include <span>

#include "sim_clock/explore/bytes_strategy.hpp"
#include "sim_clock/explore/random_generator.hpp"

namespace ltsim {

class RecordMutator {
 public:
  /// @param decisions  of recent executions: no record is aimed at what is never asked
  RecordMutator(const BytesStrategy::DecisionCounts& decisions, unsigned seed) noexcept
      : decisions_(decisions), random_(seed) {}

  /// Puts in, takes away, repeats or exchanges records, or changes one field of one.
  /// @param size  bytes of `data` that are the input
  /// @return      the new size, at most data.size()
  std::size_t mutate(std::span<std::byte> data, std::size_t size) noexcept;
  /// The first records of one, then the last of the other. @return the bytes of `into` that are it
  std::size_t splice(std::span<const std::byte> one, std::span<const std::byte> other,
                     std::span<std::byte> into) noexcept;

 private:
  using Record = BytesStrategy::Record;

  [[nodiscard]] Record draw() noexcept;
  [[nodiscard]] std::uint8_t draw_kind() noexcept;
  [[nodiscard]] std::uint16_t draw_skipped(std::uint8_t kind) noexcept;
  /// Small ones more often.
  [[nodiscard]] std::uint16_t draw_number() noexcept;
  void change_field(std::span<std::byte, BytesStrategy::record_bytes> record) noexcept;
  [[nodiscard]] std::size_t below(std::size_t bound) noexcept {
    return random_.below(static_cast<std::uint32_t>(bound));
  }

  const BytesStrategy::DecisionCounts& decisions_;
  RandomGenerator random_;
};

}  // namespace ltsim
