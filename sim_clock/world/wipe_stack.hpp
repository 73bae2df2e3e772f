// Zeros where functions that have returned had their frames: what comes there next finds none of their words.
#pragma once

#include <cstddef>
#include <cstring>

namespace ltsim {

/// More than the simulator's own functions use that run on the stack of a task, and are no part of it.
inline constexpr std::size_t stack_bytes_of_ours = 768;

/// So many bytes below the caller's frame.
template <std::size_t bytes>
[[gnu::noinline]] void wipe_stack() noexcept {
  std::byte below[bytes];
  std::memset(below, 0, bytes);
  asm volatile("" : : "r"(below) : "memory");
}

}  // namespace ltsim
