#include "sim_clock/world/heap.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {
namespace {

/// Zeros of the system's own; never given back.
template <typename Entry>
Entry* map_table(std::size_t count) noexcept {
  void* const memory = mmap(nullptr, count * sizeof(Entry), PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  LTSIM_CHECK(memory != MAP_FAILED);
  return static_cast<Entry*>(memory);
}

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
  if (blocks_ == nullptr) {
    blocks_ = map_table<Block>(blocks_max);
    allocated_by_ = map_table<std::uint32_t>(tasks_max + 1);
  }
  count_ = 0;
  overflowed_ = false;
  running_ = &running;
  std::fill_n(allocated_by_, tasks_max + 1, 0U);
  is_on_ = true;
}

void Heap::end() noexcept {
  is_on_ = false;
  running_ = nullptr;
  count_ = 0;
}

const Heap::Block* Heap::find(std::uintptr_t address) noexcept {
  if (count_ == 0 || address < blocks_[0].begin) return nullptr;
  std::size_t index = index_of(blocks(), address);
  if (index == count_ || blocks_[index].begin != address) --index;
  const Block& block = blocks_[index];
  return address <= block.begin + block.bytes ? &block : nullptr;
}

void Heap::allocated(const void* begin, std::size_t bytes) noexcept {
  bytes = std::max(bytes, std::size_t{1});
  forget_freed(number_of(begin), bytes);
  if (count_ == blocks_max) {
    overflowed_ = true;
    return;
  }
  const std::size_t owner = *running_ == nullptr ? tasks_max : (*running_)->id;
  const std::size_t index = index_of(blocks(), number_of(begin));
  std::memmove(blocks_ + index + 1, blocks_ + index, (count_ - index) * sizeof(Block));
  blocks_[index] = {.begin = number_of(begin),
                    .bytes = bytes,
                    .name = std::uint64_t{owner} << 32U | ++allocated_by_[owner],
                    .is_freed = false};
  ++count_;
}

void Heap::allocated_by_others(const void* begin, std::size_t bytes) noexcept {
  forget_freed(number_of(begin), bytes);
}

void Heap::forget_freed(std::uintptr_t begin, std::size_t bytes) noexcept {
  std::size_t first = index_of(blocks(), begin);
  if (first != 0 && blocks_[first - 1].begin + blocks_[first - 1].bytes > begin) --first;
  std::size_t end = first;
  while (end != count_ && blocks_[end].begin < begin + bytes) ++end;
  if (first == end) return;
  std::memmove(blocks_ + first, blocks_ + end, (count_ - end) * sizeof(Block));
  count_ -= end - first;
}

Heap::Block* Heap::block_at(const void* begin) noexcept {
  const std::size_t index = index_of(blocks(), number_of(begin));
  const bool is_there =
      index != count_ && blocks_[index].begin == number_of(begin) && !blocks_[index].is_freed;
  return is_there ? &blocks_[index] : nullptr;
}

void Heap::freed(const void* begin) noexcept {
  if (Block* const block = block_at(begin); block != nullptr) block->is_freed = true;
}

std::size_t Heap::bytes_of(const void* begin) noexcept {
  const Block* const block = block_at(begin);
  return block == nullptr ? 0 : block->bytes;
}

}  // namespace ltsim
