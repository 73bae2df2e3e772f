// Blocks of a whole program's heap, for the functions that allocate and free: in a task, or before main().
#pragma once

#include <cstddef>
#include <cstring>

#include "sim_clock/world/world.hpp"

namespace ltsim {

/// Where ProgramHeap::serves(caller). @return null: there is no room
inline void* allocate_for_program(std::size_t bytes, std::size_t alignment, const void* caller) noexcept {
  if (current_task == nullptr) return ProgramHeap::allocate(bytes, alignment, ProgramImage::site_of(caller));
  return current_task->world->program_memory().allocate(bytes, alignment, caller);
}

/// @param block  in the range of the heap
inline void free_of_program(void* block, const void* caller) noexcept {
  if (current_task != nullptr) {
    current_task->world->program_memory().free(block, caller);
    return;
  }
  // Before main(); or after an execution, which has taken all blocks with it.
  ProgramHeap::Block* const found = ProgramHeap::block_that_begins_at(block);
  if (found != nullptr && !found->is_freed) ProgramHeap::free(*found, ProgramImage::site_of(caller));
}

/// @param block  in the range of the heap
inline void* reallocate_for_program(void* block, std::size_t bytes, const void* caller) noexcept {
  if (current_task != nullptr) return current_task->world->program_memory().reallocate(block, bytes, caller);
  const ProgramHeap::Block* const found = ProgramHeap::block_that_begins_at(block);
  const std::size_t bytes_before = found == nullptr ? 0 : found->bytes;
  void* const other = ProgramHeap::allocate(bytes, ProgramHeap::granule_bytes, ProgramImage::site_of(caller));
  if (other == nullptr) return nullptr;
  std::memcpy(other, block, bytes_before < bytes ? bytes_before : bytes);
  free_of_program(block, caller);
  return other;
}

}  // namespace ltsim
