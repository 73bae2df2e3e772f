// Words that a task must load at most once in a transaction: a second load may find another value than the one
// that was checked.
//
// A transaction of a task ends when it passes an operation that waits or hands over (semaphores, mutexes,
// conditions, joining, sleeping, yielding), and for one word when it writes that word itself. So a loop that
// polls without any of these is a second load: such a word is not to be declared. A word that is loaded in
// pieces, each once, was loaded once.
//
// Not here: a second load that only the optimiser makes and does not announce.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/operation.hpp"

namespace ltsim {

class StateHash;
class World;
struct Task;

class SingleFetch {
 public:
  static constexpr std::uint32_t word_bytes_max = 8;

  explicit SingleFetch(World& world) noexcept : world_(world) {}
  void reset() noexcept { words_count_ = 0; }

  /// See World::single_fetch().
  void declare(std::string_view segment, std::uint32_t offset, std::uint32_t bytes, std::string_view name);

  /// What of it decides what can follow.
  void add_state(StateHash& hash) const noexcept;
  /// The running task performs `operation` next. Ends the execution if that is a second load.
  void performs(const Task& task, const Operation& operation) noexcept;

 private:
  struct Fetch {
    std::uint8_t bytes_loaded = 0;  // in this transaction, a bit each
    std::uint64_t value = 0;        // of the whole word, when the last of them were loaded
  };
  struct Word {
    std::string segment;
    std::uint32_t offset = 0;
    std::uint32_t bytes = 0;
    std::string name;
    std::array<Fetch, tasks_max> fetches;  // by task number
  };

  [[noreturn]] void loaded_twice(const Word& word, const Task& task, std::uint64_t first,
                                 std::uint64_t second);

  World& world_;
  std::vector<Word> words_;  // pooled; the first words_count_ belong to this execution
  std::size_t words_count_ = 0;
};

}  // namespace ltsim
