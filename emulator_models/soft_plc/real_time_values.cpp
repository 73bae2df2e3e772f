#include "emulator_models/soft_plc/real_time_values.hpp"

#include <algorithm>

namespace emulator_models::soft_plc {

RealTimeValues::RealTimeValues(std::size_t words_count) : words_count_{std::min(words_count, words_max)} {
  for (Buffer& buffer : buffers_) buffer.words = std::make_unique<Word[]>(words_count_);
}

void RealTimeValues::publish(const ScanStamp& stamp, std::span<const std::uint64_t> values) noexcept {
  const std::uint64_t number = published_.load(std::memory_order_relaxed) + 1;  // only this thread writes it
  Buffer& buffer = buffers_[number % 2];
  // release: a reader who comes too late for this buffer sees, at the next try, which one is complete
  buffer.sequence.store(2 * number - 1, std::memory_order_release);
  // release: who sees one of the words below sees, behind his acquire fence, the odd number, too
  std::atomic_thread_fence(std::memory_order_release);
  buffer.scan_number.store(stamp.scan_number, std::memory_order_relaxed);
  buffer.time_ns.store(stamp.time.count(), std::memory_order_relaxed);
  const std::size_t given = std::min(values.size(), words_count_);
  for (std::size_t i = 0; i < given; ++i) buffer.words[i].store(values[i], std::memory_order_relaxed);
  for (std::size_t i = given; i < words_count_; ++i) buffer.words[i].store(0, std::memory_order_relaxed);
  // release: who sees the even number sees all words of it
  buffer.sequence.store(2 * number, std::memory_order_release);
  // release: who is sent to this buffer finds it complete, or being written again
  published_.store(number, std::memory_order_release);
}

ReadOutcome RealTimeValues::read(std::span<std::uint64_t> into, ScanStamp& stamp) const noexcept {
  const std::size_t wanted = std::min(into.size(), words_count_);
  for (int tries = 0; tries < tries_max; ++tries) {
    const std::uint64_t number = published_.load(std::memory_order_acquire);  // pairs with publish
    if (number == 0) return ReadOutcome::nothing_published;
    const Buffer& buffer = buffers_[number % 2];
    // acquire: the words are at least as new as their number
    if (buffer.sequence.load(std::memory_order_acquire) != 2 * number) continue;
    const ScanStamp copied{buffer.scan_number.load(std::memory_order_relaxed),
                           std::chrono::nanoseconds{buffer.time_ns.load(std::memory_order_relaxed)}};
    for (std::size_t i = 0; i < wanted; ++i) into[i] = buffer.words[i].load(std::memory_order_relaxed);
    // acquire: pairs with the release fence of a publish whose word we may have copied
    std::atomic_thread_fence(std::memory_order_acquire);
    if (buffer.sequence.load(std::memory_order_relaxed) != 2 * number) continue;
    stamp = copied;
    return ReadOutcome::read;
  }
  return ReadOutcome::busy;
}

}  // namespace emulator_models::soft_plc
