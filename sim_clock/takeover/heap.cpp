// malloc(3) and its kind. What the code of a whole program asks for lies in its own heap (world/program_heap.hpp). Otherwise the memory
// is libc's, and whoever looks at the whole state of a world is told of each block (world/heap.hpp).

#include <cerrno>
#include <cstddef>
#include <cstring>

#include "sim_clock/takeover/program_blocks.hpp"
#include "sim_clock/world/heap.hpp"
#include "sim_clock/world/wipe_stack.hpp"

// Exported by glibc for those who stand in front of malloc.
extern "C" void* __libc_malloc(std::size_t bytes);
extern "C" void* __libc_calloc(std::size_t count, std::size_t bytes);
extern "C" void* __libc_realloc(void* block, std::size_t bytes);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t bytes);
extern "C" void __libc_free(void* block);

namespace {

using ltsim::Heap;
using ltsim::ProgramHeap;

/// While something is listed: with what is allocated meanwhile, entered or not, a freed block may be gone.
[[gnu::noinline]] void* entered(void* block, std::size_t bytes) noexcept {
  if (block == nullptr) return nullptr;
  if (!Heap::is_on()) {
    Heap::allocated_by_others(block, bytes);
    return block;  // nobody's stack is looked at where nothing is entered
  }
  std::memset(block, 0, bytes);
  Heap::allocated(block, bytes);
  ltsim::wipe_stack<ltsim::stack_bytes_of_ours>();
  return block;
}

[[gnu::noinline]] void left(void* block) noexcept {
  Heap::freed(block);
  ltsim::wipe_stack<ltsim::stack_bytes_of_ours>();
}

[[gnu::noinline]] void* entered_again(void* block, std::size_t bytes) noexcept {
  const std::size_t before = Heap::bytes_of(block);
  void* const other = entered(__libc_malloc(bytes), bytes);
  if (other == nullptr) return nullptr;
  std::memcpy(other, block, before < bytes ? before : bytes);
  left(block);
  __libc_free(block);
  return other;
}

void* allocate_aligned(std::size_t alignment, std::size_t bytes, const void* caller) noexcept {
  if (ProgramHeap::serves(caller)) return ltsim::allocate_for_program(bytes, alignment, caller);
  void* const block = __libc_memalign(alignment, bytes);
  return Heap::is_listing() ? entered(block, bytes) : block;
}

}  // namespace

extern "C" void* malloc(std::size_t bytes) {
  if (const void* const caller = __builtin_return_address(0); ProgramHeap::serves(caller)) [[unlikely]]
    return ltsim::allocate_for_program(bytes, ProgramHeap::granule_bytes, caller);
  if (Heap::is_listing()) [[unlikely]]
    return entered(__libc_malloc(bytes), bytes);
  return __libc_malloc(bytes);
}

extern "C" void* calloc(std::size_t count, std::size_t bytes) {
  if (const void* const caller = __builtin_return_address(0); ProgramHeap::serves(caller)) [[unlikely]] {
    std::size_t all = 0;
    if (__builtin_mul_overflow(count, bytes, &all)) {
      errno = ENOMEM;
      return nullptr;
    }
    void* const block = ltsim::allocate_for_program(all, ProgramHeap::granule_bytes, caller);
    return block == nullptr ? nullptr : std::memset(block, 0, all);
  }
  void* const block = __libc_calloc(count, bytes);
  return Heap::is_listing() ? entered(block, count * bytes) : block;
}

extern "C" void* realloc(void* block, std::size_t bytes) {
  const void* const caller = __builtin_return_address(0);
  if (block == nullptr && ProgramHeap::serves(caller)) [[unlikely]]
    return ltsim::allocate_for_program(bytes, ProgramHeap::granule_bytes, caller);
  if (ProgramHeap::contains(block)) [[unlikely]]
    return ltsim::reallocate_for_program(block, bytes, caller);
  if (Heap::is_listing() && block == nullptr) [[unlikely]]
    return entered(__libc_malloc(bytes), bytes);
  if (Heap::is_listing() && Heap::bytes_of(block) != 0) [[unlikely]] {
    if (bytes != 0) return entered_again(block, bytes);
    left(block);
  }
  void* const other = __libc_realloc(block, bytes);
  if (Heap::is_listing() && other != nullptr) [[unlikely]]
    Heap::allocated_by_others(other, bytes);
  return other;
}

extern "C" void free(void* block) {
  if (ProgramHeap::contains(block)) [[unlikely]] {
    ltsim::free_of_program(block, __builtin_return_address(0));
    return;
  }
  if (Heap::is_listing()) [[unlikely]]
    left(block);
  __libc_free(block);
}

extern "C" void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return allocate_aligned(alignment, bytes, __builtin_return_address(0));
}

extern "C" void* memalign(std::size_t alignment, std::size_t bytes) {
  return allocate_aligned(alignment, bytes, __builtin_return_address(0));
}

extern "C" int posix_memalign(void** into, std::size_t alignment, std::size_t bytes) {
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
  void* const block = allocate_aligned(alignment, bytes, __builtin_return_address(0));
  if (block == nullptr) return ENOMEM;
  *into = block;
  return 0;
}
