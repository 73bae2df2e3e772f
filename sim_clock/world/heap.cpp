#include "sim_clock/world/heap.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {
namespace {

std::uintptr_t number_of(const void* address) noexcept { return reinterpret_cast<std::uintptr_t>(address); }

/// Where a block that begins there is, or would be.
std::size_t index_of(std::span<const Heap::Block> blocks, std::uintptr_t address) noexcept {
  return static_cast<std::size_t>(
      std::lower_bound(blocks.begin(), blocks.end(), address,
                       [](const Heap::Block& block, std::uintptr_t wanted) { return block.begin < wanted; }) -
      blocks.begin());
}

}  // namespace

void Heap::begin(Task* const& running) noexcept {
  if (table_ == nullptr) {
    void* const memory = mmap(nullptr, sizeof(Table), PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    LTSIM_CHECK(memory != MAP_FAILED);
    table_ = static_cast<Table*>(memory);  // zeros
  }
  table_->count = 0;
  table_->overflowed = false;
  table_->running = &running;
  table_->allocated_by.fill(0);
  is_listing_ = is_on_ = true;
}

void Heap::end() noexcept { is_listing_ = is_on_ = false; }

const Heap::Block* Heap::find(std::uintptr_t address) noexcept {
  const auto all = blocks();
  if (all.empty() || address < all.front().begin) return nullptr;
  std::size_t index = index_of(all, address);
  if (index == all.size() || all[index].begin != address) --index;
  const Block& block = all[index];
  return address <= block.begin + block.bytes ? &block : nullptr;
}

void Heap::allocated(const void* begin, std::size_t bytes) noexcept {
  bytes = std::max(bytes, std::size_t{1});
  forget_freed(number_of(begin), bytes);
  if (table_->count == blocks_max) {
    table_->overflowed = true;
    return;
  }
  const std::size_t owner = *table_->running == nullptr ? tasks_max : (*table_->running)->id;
  Block* const all = table_->blocks.data();
  const std::size_t index = index_of(blocks(), number_of(begin));
  std::memmove(all + index + 1, all + index, (table_->count - index) * sizeof(Block));
  all[index] = {.begin = number_of(begin),
                .bytes = bytes,
                .name = std::uint64_t{owner} << 32U | ++table_->allocated_by[owner],
                .is_freed = false};
  ++table_->count;
}

void Heap::allocated_by_others(const void* begin, std::size_t bytes) noexcept {
  forget_freed(number_of(begin), bytes);
}

void Heap::forget_freed(std::uintptr_t begin, std::size_t bytes) noexcept {
  const auto all = blocks();
  std::size_t first = index_of(all, begin);
  if (first != 0 && all[first - 1].begin + all[first - 1].bytes > begin) --first;
  std::size_t end = first;
  while (end != all.size() && all[end].begin < begin + bytes) ++end;
  if (first == end) return;
  std::memmove(table_->blocks.data() + first, table_->blocks.data() + end,
               (all.size() - end) * sizeof(Block));
  table_->count -= end - first;
}

Heap::Block* Heap::block_at(const void* begin) noexcept {
  const std::size_t index = index_of(blocks(), number_of(begin));
  if (index == table_->count) return nullptr;
  Block& block = table_->blocks[index];
  return block.begin == number_of(begin) && !block.is_freed ? &block : nullptr;
}

void Heap::freed(const void* begin) noexcept {
  if (Block* const block = block_at(begin); block != nullptr) block->is_freed = true;
}

std::size_t Heap::bytes_of(const void* begin) noexcept {
  const Block* const block = block_at(begin);
  return block == nullptr ? 0 : block->bytes;
}

}  // namespace ltsim
