// memcpy and its kind. A copy from or to shared memory is TEARABLE: it is made in pieces of eight bytes with a
// scheduling point before each read and each write of a piece, for that is how another processor may see it. In
// a whole program that is so for what its own code copies.

#include <dlfcn.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "sim_clock/takeover/shared_access.hpp"
#include "sim_clock/world/world.hpp"

namespace {

using ltsim::OperationKind;
using ltsim::Segments;

// Reached before static initialisation, so found without any guard: first use looks it up, and the look-up
// itself may copy.
template <typename Function>
struct NextFunction {
  const char* name;
  Function* function = nullptr;
  bool looking = false;

  /// Null while the look-up runs.
  Function* get() noexcept {
    if (function == nullptr && !looking) [[unlikely]] {
      looking = true;
      function = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
      looking = false;
    }
    return function;
  }
};

constinit NextFunction<void*(void*, const void*, std::size_t)> next_memcpy{"memcpy"};
constinit NextFunction<void*(void*, const void*, std::size_t)> next_memmove{"memmove"};
constinit NextFunction<void*(void*, int, std::size_t)> next_memset{"memset"};

constexpr std::size_t piece_bytes = 8;

void point(const volatile void* address, std::size_t bytes, OperationKind kind, std::uint32_t site) noexcept {
  if (Segments::contains(address)) {
    ltsim::access_shared(*ltsim::current_task->world, address, bytes, kind, site);
  } else {
    ltsim::access_program(*ltsim::current_task->world, address, bytes, kind, site);
  }
}

/// The bytes are moved by instructions, not by a call that would lead back here.
inline void move_bytes(std::byte* to, const std::byte* from, std::size_t bytes) noexcept {
  asm volatile("rep movsb" : "+D"(to), "+S"(from), "+c"(bytes) : : "memory");
}

inline void fill_bytes(std::byte* to, int value, std::size_t bytes) noexcept {
  asm volatile("rep stosb" : "+D"(to), "+c"(bytes) : "a"(value) : "memory");
}

void copy_piece(std::byte* to, const std::byte* from, std::size_t bytes, std::uint32_t site) noexcept {
  std::byte piece[piece_bytes];
  point(from, bytes, OperationKind::read, site);
  move_bytes(piece, from, bytes);
  point(to, bytes, OperationKind::write, site);
  move_bytes(to, piece, bytes);
}

void* copy_in_pieces(void* to, const void* from, std::size_t bytes, std::uint32_t site) noexcept {
  auto* const target = static_cast<std::byte*>(to);
  const auto* const source = static_cast<const std::byte*>(from);
  const bool overlaps_upward = target > source && target < source + bytes;
  for (std::size_t done = 0; done < bytes;) {
    const std::size_t piece = std::min(piece_bytes, bytes - done);
    const std::size_t at = overlaps_upward ? bytes - done - piece : done;
    copy_piece(target + at, source + at, piece, site);
    done += piece;
  }
  return to;
}

bool is_shared(const void* address, std::uint32_t site) noexcept {
  return Segments::contains(address) ||
         (site != 0 && ltsim::ProgramMemory::is_on() && ltsim::ProgramMemory::find(address));
}

bool is_shared_copy(const void* a, const void* b, std::uint32_t site) noexcept {
  return ltsim::current_task != nullptr && (is_shared(a, site) || is_shared(b, site));
}

template <typename Next>
void* copy(Next& next, void* to, const void* from, std::size_t bytes, const void* caller) noexcept {
  const std::uint32_t site = ltsim::ProgramImage::site_of(caller);
  if (is_shared_copy(to, from, site)) [[unlikely]]
    return copy_in_pieces(to, from, bytes, site);
  auto* const function = next.get();
  if (function != nullptr) [[likely]]
    return function(to, from, bytes);
  move_bytes(static_cast<std::byte*>(to), static_cast<const std::byte*>(from), bytes);
  return to;
}

void* fill(void* to, int value, std::size_t bytes, const void* caller) noexcept {
  const std::uint32_t site = ltsim::ProgramImage::site_of(caller);
  if (ltsim::current_task != nullptr && is_shared(to, site)) [[unlikely]] {
    for (std::size_t done = 0; done < bytes; done += piece_bytes) {
      const std::size_t piece = std::min(piece_bytes, bytes - done);
      point(static_cast<std::byte*>(to) + done, piece, OperationKind::write, site);
      fill_bytes(static_cast<std::byte*>(to) + done, value, piece);
    }
    return to;
  }
  auto* const function = next_memset.get();
  if (function != nullptr) [[likely]]
    return function(to, value, bytes);
  fill_bytes(static_cast<std::byte*>(to), value, bytes);
  return to;
}

}  // namespace

extern "C" void* memcpy(void* to, const void* from, std::size_t bytes) noexcept {
  return copy(next_memcpy, to, from, bytes, __builtin_return_address(0));
}
extern "C" void* memmove(void* to, const void* from, std::size_t bytes) noexcept {
  return copy(next_memmove, to, from, bytes, __builtin_return_address(0));
}
extern "C" void* memset(void* to, int value, std::size_t bytes) noexcept {
  return fill(to, value, bytes, __builtin_return_address(0));
}

// clang's names for the same calls in instrumented code.
extern "C" void* __tsan_memcpy(void* to, const void* from, std::size_t bytes) {
  return copy(next_memcpy, to, from, bytes, __builtin_return_address(0));
}
extern "C" void* __tsan_memmove(void* to, const void* from, std::size_t bytes) {
  return copy(next_memmove, to, from, bytes, __builtin_return_address(0));
}
extern "C" void* __tsan_memset(void* to, int value, std::size_t bytes) {
  return fill(to, value, bytes, __builtin_return_address(0));
}
