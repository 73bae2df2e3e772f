#include "sim_clock/world/program_heap.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>

#include "sim_clock/check/self_check.hpp"

namespace ltsim {
namespace {

/// What a block holds before somebody writes to it: nobody should rely on zeros.
constexpr int unwritten = 0xbe;

constexpr std::size_t up_to(std::size_t bytes, std::size_t alignment) noexcept {
  return (bytes + alignment - 1) & ~(alignment - 1);
}

void* reserve(std::uintptr_t at, std::size_t bytes) {
  void* const memory =
      mmap(reinterpret_cast<void*>(at), bytes, PROT_READ | PROT_WRITE,
           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | (at == 0 ? 0 : MAP_FIXED_NOREPLACE), -1, 0);
  LTSIM_CHECK(memory != MAP_FAILED);
  return memory;
}

}  // namespace

void ProgramHeap::begin_program() {
  LTSIM_CHECK(marks_ == nullptr);
  counts_.assign(tasks_max + 1, 0);
  LTSIM_CHECK(reserve(range_begin, range_bytes) == reinterpret_cast<void*>(range_begin));
  marks_ = static_cast<std::uint8_t*>(reserve(0, range_bytes / granule_bytes));
}

void* ProgramHeap::allocate(std::size_t bytes, std::size_t alignment, std::uint32_t site) noexcept {
  if (bytes > range_bytes || alignment > range_bytes) return nullptr;
  const std::size_t begin = up_to(used_bytes_ + gap_bytes, std::max(alignment, granule_bytes));
  const std::size_t end = begin + up_to(std::max(bytes, std::size_t{1}), granule_bytes);
  if (end + gap_bytes > range_bytes) return nullptr;
  used_bytes_ = end;
  const TaskId owner = current_task == nullptr ? no_owner : current_task->id;
  const std::size_t count_of = owner == no_owner ? tasks_max : owner;
  blocks_.push_back({.offset = static_cast<std::uint32_t>(begin),
                     .bytes = static_cast<std::uint32_t>(bytes),
                     .owner = owner,
                     .number = ++counts_[count_of],
                     .site = site});
  mark(blocks_.back());
  void* const block = address_of(static_cast<std::uint32_t>(begin));
  std::memset(block, unwritten, bytes);
  return block;
}

void ProgramHeap::mark(const Block& block) noexcept {
  const std::size_t first = block.offset / granule_bytes;
  if (block.is_freed) {
    std::memset(marks_ + first, mark_freed, up_to(block.bytes, granule_bytes) / granule_bytes);
    return;
  }
  const std::size_t whole = block.bytes / granule_bytes;
  std::memset(marks_ + first, granule_bytes, whole);
  if (const std::size_t rest = block.bytes % granule_bytes; rest != 0)
    marks_[first + whole] = static_cast<std::uint8_t>(rest);
}

ProgramHeap::Block* ProgramHeap::block_that_begins_at(const void* address) noexcept {
  const std::uint32_t offset = offset_of(address);
  const auto found = std::lower_bound(blocks_.begin(), blocks_.end(), offset,
                                      [](const Block& block, std::uint32_t at) { return block.offset < at; });
  return found == blocks_.end() || found->offset != offset ? nullptr : &*found;
}

void ProgramHeap::free(Block& block, std::uint32_t site) noexcept {
  block.is_freed = true;
  block.freed_by = current_task == nullptr ? no_owner : current_task->id;
  block.freed_site = site;
  mark(block);
}

const ProgramHeap::Block* ProgramHeap::block_at(std::uint32_t offset) noexcept {
  const auto next = std::upper_bound(blocks_.begin(), blocks_.end(), offset,
                                     [](std::uint32_t at, const Block& block) { return at < block.offset; });
  return next == blocks_.begin() ? nullptr : &*(next - 1);
}

ProgramHeap::Access ProgramHeap::check_slowly(std::size_t offset, std::size_t bytes) noexcept {
  for (std::size_t at = offset; at < offset + bytes; ++at) {
    const std::uint8_t mark = marks_[at / granule_bytes];
    if (mark == mark_freed) return Access::freed;
    if (at % granule_bytes >= mark) return Access::outside;
  }
  return Access::valid;
}

void ProgramHeap::keep_for_each_execution() {
  const auto* const begin = reinterpret_cast<const std::byte*>(range_begin);
  kept_bytes_.assign(begin, begin + used_bytes_);
  kept_blocks_ = blocks_;
  kept_count_ = counts_[tasks_max];
}

void ProgramHeap::restore() {
  if (used_bytes_ == 0) return;
  std::memset(marks_, mark_outside, used_bytes_ / granule_bytes + 1);
  blocks_ = kept_blocks_;
  for (const Block& block : blocks_) mark(block);
  used_bytes_ = kept_bytes_.size();
  if (used_bytes_ != 0) std::memcpy(reinterpret_cast<void*>(range_begin), kept_bytes_.data(), used_bytes_);
  std::fill(counts_.begin(), counts_.end(), 0);
  counts_[tasks_max] = kept_count_;
}

void ProgramHeap::restore_image(std::size_t image) {
  const ImagePart begin = image == 0 ? ImagePart{} : images_[image - 1];
  const ImagePart& end = images_[image];
  for (std::size_t i = begin.blocks_end; i < end.blocks_end; ++i) {
    blocks_[i] = kept_blocks_[i];
    mark(blocks_[i]);
  }
  std::memcpy(address_of(static_cast<std::uint32_t>(begin.bytes_end)), &kept_bytes_[begin.bytes_end],
              end.bytes_end - begin.bytes_end);
}

}  // namespace ltsim
