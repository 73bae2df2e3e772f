// The current values of a cycle, for any thread at any time: the images of one whole scan, never of two.
//
// Two buffers, each with a sequence number that is odd while it is written (a seqlock over two). A scan publishes
// into the older one, readers copy the newer one and look whether its number has stayed. Why not one seqlock: a cycle
// that is interrupted in the middle of publishing would hold up all readers; why not a triple buffer: it has one
// reader.
//
// Invariants
//   I1  publish() never waits: its steps depend on the number of words only.
//   I2  what read() returns was published by one publish(), whole.
//   I3  for each reader scan numbers never go back.
//   I4  a reader has to try again only if a publish() has ended and another begun while it copied; a publisher that
//       stands still delays nobody.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace emulator_models::soft_plc {

/// Which scan the values are of.
struct ScanStamp {
  std::uint64_t scan_number = 0;
  std::chrono::nanoseconds time{0};  ///< end of the scan, since power-up

  friend bool operator==(const ScanStamp&, const ScanStamp&) = default;
};

enum class ReadOutcome : std::uint8_t {
  read,
  nothing_published,  ///< no scan is complete yet
  busy,  ///< tries_max times overtaken; only a cycle without pauses between its scans can do that
};

class RealTimeValues {
 public:
  /// 64 bits each.
  static constexpr std::size_t words_max = 1'048'576;
  static constexpr int tries_max = 1000;

  /// @param words_count  taken down to words_max
  explicit RealTimeValues(std::size_t words_count);

  /// The cycle's thread, once a scan.
  /// @param values  words_count() of them; what is missing keeps no value of earlier scans but is 0
  void publish(const ScanStamp& stamp, std::span<const std::uint64_t> values) noexcept;

  /// Any thread.
  /// @param into   of values, from the first on, as many as fit; of no meaning unless `read`
  /// @param stamp  written when the outcome is `read`
  [[nodiscard]] ReadOutcome read(std::span<std::uint64_t> into, ScanStamp& stamp) const noexcept;

  [[nodiscard]] std::size_t words_count() const noexcept { return words_count_; }

 private:
  using Word = std::atomic<std::uint64_t>;
  static_assert(Word::is_always_lock_free);

  struct Buffer {
    alignas(64) Word sequence{0};
    Word scan_number{0};
    std::atomic<std::int64_t> time_ns{0};
    std::unique_ptr<Word[]> words;
  };

  std::size_t words_count_;
  std::array<Buffer, 2> buffers_;
  alignas(64) Word published_{0};  ///< how often; the newest is in the buffer of that number modulo 2
};

}  // namespace emulator_models::soft_plc
