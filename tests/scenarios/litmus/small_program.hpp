// Programs of a few atomic operations on a few words, as text: what litmus tests are made of.
//
//     x=1.rel ; y.acq || y=1.rel ; x.acq
//
// Tasks are separated by "||", their steps by ";". A word is x, y or z, and 0 at first. Steps, each with its memory order:
//
//     x=1.rel     a store                  x.acq     a load
//     x+=1.ar     a fetch_add              x?0:1.ar  a compare_exchange_strong of 0 for 1
//     fence.sc    an atomic_thread_fence
//
// Orders: rlx, acq, rel, ar (acquire and release), sc. A compare-exchange that fails loads with what remains of its order
// without the release.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace litmus {

inline constexpr std::size_t words_count = 3;
using Words = std::array<std::atomic<std::uint32_t>, words_count>;

struct Step {
  enum class Kind : std::uint8_t { load, store, add, compare, fence };

  Kind kind = Kind::load;
  std::memory_order order = std::memory_order_seq_cst;
  std::size_t word = 0;
  std::uint32_t value = 0;     ///< stored, added, or put in place of `expected`
  std::uint32_t expected = 0;  ///< of compare
};

[[nodiscard]] constexpr bool reads(Step::Kind kind) noexcept {
  return kind == Step::Kind::load || kind == Step::Kind::add || kind == Step::Kind::compare;
}
/// Of a compare-exchange that finds something else.
[[nodiscard]] std::memory_order order_when_failing(std::memory_order order) noexcept;

using Task = std::vector<Step>;
using Program = std::vector<Task>;
/// Of its steps, those that read.
[[nodiscard]] std::size_t reads_count(const Task& task) noexcept;

/// @throw std::invalid_argument names what is no step
[[nodiscard]] Program parse(std::string_view text);
[[nodiscard]] std::string to_string(const Program& program);

/// What an execution comes to: what each reading step has read, task by task, and what the words hold in the end.
struct Result {
  std::vector<std::uint32_t> read;
  std::array<std::uint32_t, words_count> words{};

  auto operator<=>(const Result&) const = default;
};

/// "1 0 | 1 1 0"
[[nodiscard]] std::string to_string(const Result& result);

/// Whether it is as a pattern says: like to_string(), any number for a '*'; what the pattern leaves out at the end, and the
/// part behind '|', may be anything.
[[nodiscard]] bool matches(const Result& result, std::string_view pattern);

/// Carries out the steps of one task.
/// @param read  where what its reading steps read goes, in their order
void run(const Task& task, Words& words, std::uint32_t* read);

}  // namespace litmus
