// A depth-first search in parts that several processes can be at, with the result of the search in one go.
//
// A part is all executions that begin with the same choices. It is searched in one piece (a leaf: DecisionPath), or was split at
// its first decision into one part for each choice that has been begun there (a branch). Only what is certain to be searched is
// begun, and with what is asleep for it in the search in one go:
//
//   - What a part finds does not depend on what other parts find, so it can be searched at any time, in any process.
//   - Races within a part may show that something must be tried at a branch above it. In the search in one go the parts come one
//     after the other, in the order of the tree; so these requests wait in their part until all parts before it are over, and
//     then reach the branch (settle()).
//   - What must be tried at a decision is tried in the order in which that was found (Decision::order). So what is known of it at
//     any time is the beginning of what will be known in the end, and who sleeps is known for each.
//
// Hence executions, redundant ones and all else that is counted are the same, however the search was split, in how many processes
// it was, and how often it was interrupted; and the first failure is the first in the order of the tree. That needs parts whose
// search is a function of their choices alone: not one that leaves states that were seen elsewhere (ProofBounds::states), which
// must be searched in one go.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/explore/decision_path.hpp"

namespace ltsim {

struct SearchCounts {
  std::uint64_t executions = 0;  ///< that went to their end; redundant ones do not count
  std::uint64_t redundant = 0;   ///< left when they came to nothing new
  std::uint64_t cut_off = 0;     ///< of `executions`: longer than ExhaustiveStrategy::steps_max
  std::uint64_t held_back = 0;   ///< of `executions`: ProofBounds::looks made a polling task wait
  std::uint64_t points = 0;

  SearchCounts& operator+=(const SearchCounts& other) noexcept;
  bool operator==(const SearchCounts&) const = default;
};

/// Why no further execution of a part was run.
enum class SliceEnd : std::uint8_t {
  over,      ///< there is none
  stopped,   ///< it was time
  failed,    ///< the last one failed: `rest` leads to it
  in_error,  ///< SearchedSlice::error
};

/// What a process has done of a leaf since it has got it.
struct SearchedSlice {
  SliceEnd end = SliceEnd::stopped;
  SearchCounts counts{};
  std::vector<TreeRequest> requests{};
  std::vector<Decision> rest{};
  std::string error{};
};

/// Text for another process.
[[nodiscard]] std::string to_text(const SearchItem& item);
[[nodiscard]] std::optional<SearchItem> parse_item(std::string_view text);
[[nodiscard]] std::string to_text(const SearchedSlice& slice);
[[nodiscard]] std::optional<SearchedSlice> parse_slice(std::string_view text);

class SearchTree {
 public:
  class Part;

  /// Nothing has been searched yet.
  SearchTree();
  ~SearchTree();
  SearchTree(SearchTree&&) noexcept;
  SearchTree& operator=(SearchTree&&) noexcept;

  /// A leaf for a process to be at: the first that nobody is at; if there is none, it is begun, where most may be left. None after
  /// one that failed, or in which there was an error. @return null: there is none now
  [[nodiscard]] Part* take();
  /// Where the search of it stands; if it has failed, at the execution that does.
  [[nodiscard]] static SearchItem item_of(const Part& leaf);
  /// What counts() and done() are to know of it while the process is at it.
  static void note_progress(Part& leaf, const SearchCounts& counts, double done) noexcept;
  /// The process is not at it any more. @param more_are_wanted  split it, if it can be
  void give_back(Part& leaf, SearchedSlice slice, bool more_are_wanted);
  /// Everything was searched.
  [[nodiscard]] bool is_complete() const noexcept;
  /// The first part that failed or in which there was an error; null: none.
  [[nodiscard]] const Part* ended() const noexcept;
  [[nodiscard]] static const SearchedSlice& end_of(const Part& leaf) noexcept;
  /// Nobody is at a part that comes before ended(), or at any if there is none, and take() has none.
  [[nodiscard]] bool is_over() const noexcept;

  /// Of all that was searched up to ended().
  [[nodiscard]] SearchCounts counts() const noexcept;
  /// How much of the search is over, by what is known of it now: 0 to 1. More may turn up.
  [[nodiscard]] double done() const noexcept;

  /// All of it, as lines. Parts that processes are at, and those that failed, stand where they were when they were taken.
  [[nodiscard]] std::string checkpoint() const;
  [[nodiscard]] static std::optional<SearchTree> parse(std::string_view checkpoint);

 private:
  static void settle(Part& branch);

  std::unique_ptr<Part> root_;
};

}  // namespace ltsim
