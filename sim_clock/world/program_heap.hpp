// The heap of a whole program: malloc(3) and operator new, for what the program itself asks for.
//
// Blocks lie one after the other in a range of addresses that is the same in each run, and none lies where another one was before,
// so that an access to a freed block is seen. What a library asks for on its own account (a stream's buffer) is none of this: the
// library may keep it longer than an execution lasts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim_clock/world/program_image.hpp"
#include "sim_clock/world/task.hpp"

namespace ltsim {

class ProgramHeap {
 public:
  static constexpr std::uintptr_t range_begin = std::uintptr_t{5} << 39U;
  static constexpr std::size_t range_bytes = std::size_t{1} << 28U;  // 256 MiB
  /// Alignment of each block, and what the marks stand for.
  static constexpr std::size_t granule_bytes = 16;

  struct Block {
    std::uint32_t offset = 0;  // in the range
    std::uint32_t bytes = 0;
    TaskId owner = 0;          // the task that allocated it; no_owner: before main()
    std::uint32_t number = 0;  // which of its owner's, from 1
    std::uint32_t site = 0;    // as in Operation: where it was allocated
    TaskId freed_by = 0;
    std::uint32_t freed_site = 0;
    bool is_freed = false;
  };
  static constexpr TaskId no_owner = VirtualClock::no_task;

  enum class Access : std::uint8_t { valid, freed, outside };

  [[nodiscard]] static bool contains(const volatile void* address) noexcept {
    return reinterpret_cast<std::uintptr_t>(address) - range_begin < range_bytes;
  }

  /// Reserves the range. Once in a program.
  static void begin_program();
  [[nodiscard]] static bool is_on() noexcept { return marks_ != nullptr; }

  /// Whether who asks for a block gets it here: code of the program, in a task or before main().
  /// @param caller  return address of the call
  [[nodiscard]] static bool serves(const void* caller) noexcept {
    return is_on() && (current_task != nullptr || serves_outside_tasks_) &&
           ProgramImage::site_of(caller) != 0;
  }
  static void serve_outside_tasks(bool yes) noexcept { serves_outside_tasks_ = yes; }
  /// Whether constructors of the program run, before main().
  [[nodiscard]] static bool serves_outside_tasks() noexcept { return serves_outside_tasks_; }

  /// @param alignment  a power of two
  /// @param site       as in Operation: who asks
  /// @return  null: the range is full, or `bytes` is more than it could hold
  [[nodiscard]] static void* allocate(std::size_t bytes, std::size_t alignment, std::uint32_t site) noexcept;
  /// @return  null: no block begins there
  [[nodiscard]] static Block* block_that_begins_at(const void* address) noexcept;
  static void free(Block& block, std::uint32_t site) noexcept;

  /// Whether each of the bytes lies in one block that is not freed.
  [[nodiscard]] static Access check(const volatile void* address, std::size_t bytes) noexcept {
    const std::size_t offset = reinterpret_cast<std::uintptr_t>(address) - range_begin;
    const std::uint8_t mark = marks_[offset / granule_bytes];
    if (offset % granule_bytes + bytes <= mark && mark <= granule_bytes) [[likely]]
      return Access::valid;
    return check_slowly(offset, bytes);
  }

  /// The block that the offset lies in, or behind; null: it lies before the first.
  [[nodiscard]] static const Block* block_at(std::uint32_t offset) noexcept;
  [[nodiscard]] static std::span<const Block> blocks() noexcept { return blocks_; }
  [[nodiscard]] static std::uint32_t offset_of(const volatile void* address) noexcept {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address) - range_begin);
  }
  [[nodiscard]] static void* address_of(std::uint32_t offset) noexcept {
    return reinterpret_cast<void*>(range_begin + offset);
  }

  /// What there is now is what each execution begins with.
  static void keep_for_each_execution();
  static void restore();
  /// What was allocated since the last call belongs to the image of the next number, from 0.
  static void end_of_image() { images_.push_back({.blocks_end = blocks_.size(), .bytes_end = used_bytes_}); }
  /// @param block  of before main()
  [[nodiscard]] static std::size_t image_of(const Block& block) noexcept {
    std::size_t image = 0;
    while (image + 1 < images_.size() && block.offset >= images_[image].bytes_end) ++image;
    return image;
  }
  /// As restore(), for the blocks of one image: its process begins again.
  static void restore_image(std::size_t image);

 private:
  // Of granules: 1 to granule_bytes: so many of its bytes from its begin on belong to a block.
  static constexpr std::uint8_t mark_outside = 0;
  static constexpr std::uint8_t mark_freed = 0xff;
  /// Between two blocks at least: what is written a little behind a block is seen.
  static constexpr std::size_t gap_bytes = granule_bytes;

  /// Of what was allocated for an image while it was loaded; it begins where that of the image before ends.
  struct ImagePart {
    std::size_t blocks_end = 0;
    std::size_t bytes_end = 0;
  };

  static void mark(const Block& block) noexcept;
  [[nodiscard]] static Access check_slowly(std::size_t offset, std::size_t bytes) noexcept;

  static inline bool serves_outside_tasks_ = false;
  static inline std::uint8_t* marks_ = nullptr;  // a byte for each granule of the range
  static inline std::size_t used_bytes_ = 0;
  static inline std::vector<Block> blocks_;          // by offset
  static inline std::vector<std::uint32_t> counts_;  // by owner, the last one for no_owner

  static inline std::vector<std::byte> kept_bytes_;
  static inline std::vector<Block> kept_blocks_;
  static inline std::uint32_t kept_count_ = 0;
  static inline std::vector<ImagePart> images_;
};

}  // namespace ltsim
