#include "sim_clock/check/memory_watch.hpp"

#include <sys/mman.h>

#include <bit>
#include <cstring>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {

static_assert(std::endian::native == std::endian::little, "a mask's low byte is the first in memory");

MemoryWatch::MemoryWatch(const std::byte* memory) : memory_(reinterpret_cast<const std::uint64_t*>(memory)) {
  // New segments hold zeros, and so does this; memory comes with use.
  void* const copy = mmap(nullptr, segment_places_count, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  LTSIM_CHECK(copy != MAP_FAILED);
  expected_ = static_cast<std::uint64_t*>(copy);
}

MemoryWatch::~MemoryWatch() { munmap(expected_, segment_places_count); }

void MemoryWatch::accept(SharedPlace place, std::size_t bytes) noexcept {
  settle();
  std::memcpy(reinterpret_cast<unsigned char*>(expected_) + place,
              reinterpret_cast<const unsigned char*>(memory_) + place, bytes);
}

void MemoryWatch::zero(SharedPlace place, std::size_t bytes) noexcept {
  settle();
  std::memset(reinterpret_cast<unsigned char*>(expected_) + place, 0, bytes);
}

std::optional<SharedPlace> MemoryWatch::find_change(SharedPlace place, std::size_t bytes) noexcept {
  settle();
  const auto* const memory = reinterpret_cast<const unsigned char*>(memory_) + place;
  const auto* const expected = reinterpret_cast<const unsigned char*>(expected_) + place;
  if (std::memcmp(memory, expected, bytes) == 0) return std::nullopt;
  for (std::size_t i = 0; i < bytes; ++i) {
    if (memory[i] != expected[i]) return static_cast<SharedPlace>(place + i);
  }
  return std::nullopt;
}

}  // namespace ltsim
