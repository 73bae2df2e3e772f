// A hash of memory that is the same wherever in the heap the code under test has its blocks.
//
// A word that holds an address in one of them (world/heap.hpp) goes in as that block's name and the distance from its begin; one in
// a block that was freed, only as that. Of the
// number of an execution, which the world writes into objects of its own, only whether it is this one goes in.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "sim_clock/world/heap.hpp"

namespace ltsim {

class StateHash {
 public:
  /// The bits in which the numbers of executions differ are the lowest; what is above tells them from other words.
  static constexpr unsigned number_bits = 40;

  /// Which blocks of the heap (Heap::blocks()) words that went in have led to, by index.
  struct Reached {
    std::vector<bool> is_reached;
    std::vector<std::size_t> to_look_at;  ///< for who follows them
  };

  /// @param reached  null: nobody asks
  explicit StateHash(std::uint64_t execution_number, Reached* reached = nullptr) noexcept
      : execution_number_(execution_number), reached_(reached) {
    if (Heap::is_listing() && !Heap::blocks().empty()) {
      heap_begin_ = Heap::blocks().front().begin;
      heap_bytes_ = Heap::blocks().back().begin + Heap::blocks().back().bytes - heap_begin_;
    }
  }

  /// A number that is no address.
  void add(std::uint64_t number) noexcept { hash_ = std::rotl((hash_ ^ number) * 0x9e3779b97f4a7c15U, 29); }

  void add_word(std::uint64_t word) noexcept {
    if (word - heap_begin_ <= heap_bytes_) [[unlikely]] {
      if (const Heap::Block* const block = Heap::find(word); block != nullptr) {
        add(block->is_freed ? freed_mark : block->name ^ heap_mark);
        if (!block->is_freed) {
          add(word - block->begin);
          if (reached_ != nullptr) reach(static_cast<std::size_t>(block - Heap::blocks().data()));
        }
        return;
      }
    }
    if (((word ^ execution_number_) >> number_bits) == 0) [[unlikely]]
      word = word == execution_number_ ? this_execution : an_earlier_execution;
    add(word);
  }

  void add_memory(const void* begin, std::size_t bytes) noexcept {
    const auto* at = static_cast<const std::byte*>(begin);
    for (; bytes >= sizeof(std::uint64_t); at += sizeof(std::uint64_t), bytes -= sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, sizeof word);
      add_word(word);
    }
    std::uint64_t rest = 0;
    std::memcpy(&rest, at, bytes);
    if (bytes != 0) add(rest);
  }

  [[nodiscard]] std::uint64_t value() const noexcept { return hash_ ^ hash_ >> 32U; }

 private:
  void reach(std::size_t index) noexcept {
    if (reached_->is_reached[index]) return;
    reached_->is_reached[index] = true;
    reached_->to_look_at.push_back(index);
  }

  static constexpr std::uint64_t heap_mark = 0xb10c'0000'0000'0000U;
  static constexpr std::uint64_t freed_mark = 0xb10c'ffff'ffff'ffffU;
  static constexpr std::uint64_t this_execution = 0xe8ec'0000'0000'0001U;
  static constexpr std::uint64_t an_earlier_execution = 0xe8ec'0000'0000'0000U;

  std::uint64_t hash_ = 0;
  std::uint64_t execution_number_;
  Reached* reached_;
  std::uintptr_t heap_begin_ = 0;
  std::uintptr_t heap_bytes_ = 0;
};

}  // namespace ltsim
