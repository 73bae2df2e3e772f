#include "sim_clock/check/linearizability.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace ltsim {
namespace {

/// The operations done so far, a bit each.
class OperationSet {
 public:
  explicit OperationSet(std::size_t operations_count) : words_((operations_count + 63) / 64) {}

  [[nodiscard]] bool holds(std::size_t operation) const noexcept {
    return (words_[operation / 64] >> (operation % 64) & 1U) != 0;
  }
  void flip(std::size_t operation) noexcept {
    words_[operation / 64] ^= std::uint64_t{1} << (operation % 64);
  }

  auto operator<=>(const OperationSet&) const = default;

 private:
  std::vector<std::uint64_t> words_;
};

class Search {
 public:
  Search(std::span<const OperationInterval> operations, std::uint32_t events_end, const SequentialStep& step)
      : step_(step), done_(operations.size()) {
    for (const OperationInterval& operation : operations) {
      if (operation.called_at >= events_end) break;
      operations_.push_back(operation);
      if (operation.returned_at >= events_end) {
        operations_.back().returned_at = OperationInterval::never;
      } else {
        ++returned_left_count_;
      }
    }
  }

  LinearizabilityResult run(StateNumber initial, std::uint64_t configurations_max) {
    if (returned_left_count_ == 0) return {};
    enter(initial, 0);
    while (!path_.empty()) {
      Configuration& here = path_.back();
      const std::size_t operation = next_candidate(here);
      if (operation == operations_.size()) {
        leave();
        continue;
      }
      here.next = operation + 1;
      const auto state = step_(here.state, operation, has_returned(operation));
      if (!state) continue;
      done_.flip(operation);
      if (!seen_.emplace(done_, *state).second) {
        done_.flip(operation);
        continue;
      }
      if (has_returned(operation) && --returned_left_count_ == 0)
        return {Linearizability::linearizable, seen_.size()};
      if (seen_.size() >= configurations_max) return {Linearizability::not_decided, seen_.size()};
      enter(*state, operation);
    }
    return {Linearizability::not_linearizable, seen_.size()};
  }

 private:
  struct Configuration {
    StateNumber state;
    std::size_t last;  // the operation that led here
    std::size_t next;  // the first one not tried yet
    /// What is called after this event comes after an operation that is not done yet.
    std::uint32_t earliest_return;
  };

  [[nodiscard]] bool has_returned(std::size_t operation) const noexcept {
    return operations_[operation].returned_at != OperationInterval::never;
  }

  void enter(StateNumber state, std::size_t last) {
    std::uint32_t earliest_return = OperationInterval::never;
    for (std::size_t i = 0; i < operations_.size(); ++i) {
      if (!done_.holds(i)) earliest_return = std::min(earliest_return, operations_[i].returned_at);
    }
    path_.push_back({.state = state, .last = last, .next = 0, .earliest_return = earliest_return});
  }

  void leave() noexcept {
    const std::size_t last = path_.back().last;
    path_.pop_back();
    if (path_.empty()) return;
    done_.flip(last);
    if (has_returned(last)) ++returned_left_count_;
  }

  [[nodiscard]] std::size_t next_candidate(const Configuration& here) const noexcept {
    std::size_t operation = here.next;
    while (operation < operations_.size() && done_.holds(operation)) ++operation;
    const bool in_time =
        operation < operations_.size() && operations_[operation].called_at < here.earliest_return;
    return in_time ? operation : operations_.size();
  }

  const SequentialStep& step_;
  std::vector<OperationInterval> operations_;
  std::size_t returned_left_count_ = 0;
  OperationSet done_;
  std::vector<Configuration> path_;
  std::set<std::pair<OperationSet, StateNumber>> seen_;
};

}  // namespace

LinearizabilityResult check_linearizability(std::span<const OperationInterval> operations,
                                            std::uint32_t events_end, StateNumber initial,
                                            const SequentialStep& step, std::uint64_t configurations_max) {
  return Search{operations, events_end, step}.run(initial, configurations_max);
}

}  // namespace ltsim
