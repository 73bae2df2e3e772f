// Plain and volatile loads and stores, as the compiler announces them with -fsanitize=thread. An access to shared
// memory by a simulated task is a scheduling point; every other one returns at once.
//
// The names and signatures are the interface between the compilers and the sanitizer's runtime: GCC,
// gcc/sanitizer.def; LLVM, lib/Transforms/Instrumentation/ThreadSanitizer.cpp. The program is not linked with
// that runtime.

#include <cstddef>

#include "sim_clock/takeover/shared_access.hpp"
#include "sim_clock/world/world.hpp"

namespace {

using ltsim::OperationKind;
using ltsim::Segments;

/// Out of line, so that the announcement of an unshared access is a subtraction, a comparison and a return.
[[gnu::noinline]] void watched_access(const volatile void* address, std::size_t bytes, OperationKind kind,
                                      const void* caller) noexcept {
  if (kind == OperationKind::write) ltsim::WholeState::written(address);
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr) return;
  if (Segments::contains(address)) {
    ltsim::access_shared(*self->world, address, bytes, kind, ltsim::ProgramImage::site_of(caller));
    return;
  }
  ltsim::access_program(*self->world, address, bytes, kind, ltsim::ProgramImage::site_of(caller));
  // Where an atomic object was, or is being made.
  if (kind == OperationKind::write) self->world->weak_memory().written_plainly(address, bytes);
}

/// Whether an access there concerns the world: it lies in shared memory, or is a write that somebody must know of.
inline bool is_watched(const volatile void* address, OperationKind kind) noexcept {
  return kind == OperationKind::read ? ltsim::is_watched_read(address) : ltsim::is_watched_write(address);
}

/// @param caller  the return address of the announcement: it stands in the code under test
inline void access(const volatile void* address, std::size_t bytes, OperationKind kind,
                   const void* caller) noexcept {
  if (is_watched(address, kind)) [[unlikely]]
    watched_access(address, bytes, kind, caller);
}

/// A range that the compiler copies or fills itself: one scheduling point per eight bytes, all before the
/// first byte moves.
inline void access_range(const volatile void* address, std::size_t bytes, OperationKind kind,
                         const void* caller) noexcept {
  if (!is_watched(address, kind)) [[likely]]
    return;
  constexpr std::size_t piece = 8;
  for (std::size_t at = 0; at < bytes; at += piece) {
    watched_access(static_cast<const volatile char*>(address) + at, bytes - at < piece ? bytes - at : piece,
                   kind, caller);
  }
  if (kind == OperationKind::write && ltsim::current_task != nullptr && Segments::contains(address))
    ltsim::current_task->world->segments().announce_write(address, bytes);
}

}  // namespace

#define LTSIM_ACCESS(name, bytes, kind)                                 \
  extern "C" void __tsan_##name##bytes(void* p) {                       \
    access(p, bytes, OperationKind::kind, __builtin_return_address(0)); \
  }

#define LTSIM_ACCESSES(bytes)                        \
  LTSIM_ACCESS(read, bytes, read)                    \
  LTSIM_ACCESS(write, bytes, write)                  \
  LTSIM_ACCESS(unaligned_read, bytes, read)          \
  LTSIM_ACCESS(unaligned_write, bytes, write)        \
  LTSIM_ACCESS(volatile_read, bytes, read)           \
  LTSIM_ACCESS(volatile_write, bytes, write)         \
  LTSIM_ACCESS(unaligned_volatile_read, bytes, read) \
  LTSIM_ACCESS(unaligned_volatile_write, bytes, write)

LTSIM_ACCESSES(1)
LTSIM_ACCESSES(2)
LTSIM_ACCESSES(4)
LTSIM_ACCESSES(8)
LTSIM_ACCESSES(16)

extern "C" void __tsan_read_range(void* p, std::size_t bytes) {
  access_range(p, bytes, OperationKind::read, __builtin_return_address(0));
}
extern "C" void __tsan_write_range(void* p, std::size_t bytes) {
  access_range(p, bytes, OperationKind::write, __builtin_return_address(0));
}

// Announced too, and of no interest here: virtual table pointers, function entry and exit.
extern "C" void __tsan_vptr_update(void** /*vptr*/, void* /*value*/) {}
extern "C" void __tsan_vptr_read(void** /*vptr*/) {}
extern "C" void __tsan_func_entry(void* /*caller*/) {}
extern "C" void __tsan_func_exit() {}

/// The runtime's start: each object of an image calls it before anything else in it runs.
extern "C" void __tsan_init() { ltsim::ProgramImage::begins(__builtin_return_address(0)); }
