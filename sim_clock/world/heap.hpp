// The blocks of the heap that the code under test has, for who looks at the whole state of a world (whole_state.hpp).
//
// While it is on, each block that is allocated is entered, by malloc and by all that calls it, and is filled with zeros: what it
// holds then follows from what the program did. A block has a name that does not depend on where it lies: who allocated it, and
// as which of his blocks.
//
// Off, an allocation costs one branch more than without it. For programs of one system thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sim_clock/world/task.hpp"

namespace ltsim {

class Heap {
 public:
  /// Most blocks at a time, freed ones included.
  static constexpr std::size_t blocks_max = std::size_t{1} << 16U;

  struct Block {
    std::uintptr_t begin = 0;
    std::size_t bytes = 0;  // >= 1
    std::uint64_t name = 0;
    bool is_freed = false;  // and nothing else lies there yet: an address in it means nothing

    /// tasks_max: none.
    [[nodiscard]] std::size_t allocated_by() const noexcept { return name >> 32U; }
  };

  /// Whether blocks are entered.
  [[nodiscard]] static bool is_on() noexcept { return is_on_; }
  /// From begin() to end(), pauses included.
  [[nodiscard]] static bool is_listing() noexcept { return is_listing_; }

  /// From here on blocks are entered; there are none yet.
  /// @param running  the task that runs, at any time until end(); null: none
  static void begin(Task* const& running) noexcept;
  /// Forgets all blocks.
  static void end() noexcept;
  /// There were more than blocks_max at a time: some are missing.
  [[nodiscard]] static bool overflowed() noexcept { return table_->overflowed; }

  /// While it lives, what is allocated is no block of the code under test.
  class Pause {
   public:
    Pause() noexcept : was_on_(is_on_) { is_on_ = false; }
    ~Pause() { is_on_ = was_on_; }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    bool was_on_;
  };

  /// While it lists them, in the order of their addresses.
  [[nodiscard]] static std::span<const Block> blocks() noexcept {
    return {table_->blocks.data(), table_->count};
  }
  /// The block that the address lies in, or is the end of, freed or not; null: none.
  [[nodiscard]] static const Block* find(std::uintptr_t address) noexcept;

  // --- for takeover/heap.cpp ---

  /// @param begin  filled with zeros already, or with what was in a block that this one is in place of
  static void allocated(const void* begin, std::size_t bytes) noexcept;
  /// While nothing is entered: what was freed there may be something else now.
  static void allocated_by_others(const void* begin, std::size_t bytes) noexcept;
  /// A block that is not listed is left alone.
  static void freed(const void* begin) noexcept;
  /// Of a block that is listed and not freed; otherwise 0.
  [[nodiscard]] static std::size_t bytes_of(const void* begin) noexcept;

 private:
  [[nodiscard]] static Block* block_at(const void* begin) noexcept;
  static void forget_freed(std::uintptr_t begin, std::size_t bytes) noexcept;

  struct Table {
    bool overflowed;
    Task* const* running;
    std::size_t count;
    std::array<std::uint32_t, tasks_max + 1> allocated_by;  // by task: how many so far; the last one: by none
    std::array<Block, blocks_max> blocks;
  };

  static inline bool is_listing_ = false;
  static inline bool is_on_ = false;
  /// From the system: what allocates must not allocate, and what is listed changes with the way into a state, so that it must be
  /// no variable of the program. Null until it is needed.
  static inline Table* table_ = nullptr;
};

}  // namespace ltsim
