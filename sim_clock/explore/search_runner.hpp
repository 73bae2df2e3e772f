// Runs the executions of parts of an exhaustive search, one part at a time, in this process.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "sim_clock/explore/exhaustive_strategy.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/search_tree.hpp"

namespace ltsim {

struct ProveOptions {
  ProofBounds bounds;
  Memory memory = Memory::sc;
  Findings findings = {};
  std::optional<std::chrono::duration<double>> seconds_max;  ///< of real time
  std::chrono::duration<double> minimize_seconds{0};
};

class SearchRunner {
 public:
  /// @param world, scenario, options  outlive this
  SearchRunner(World& world, const Scenario& scenario, const ProveOptions& options);

  /// Runs one execution that is no part of the search: what is initialised on first use must be so in all executions alike. Before
  /// search().
  /// @throw Explorer::NotSimulable
  void warm_up();

  /// Runs at least one execution. @param goes_on  asked after each of them but the last, with what was counted so far
  [[nodiscard]] SearchedSlice search(const SearchItem& item,
                                     const std::function<bool(const SearchCounts&)>& goes_on);
  /// While `goes_on` is asked: how much of the part is over, by what is known of it now.
  [[nodiscard]] double done() const noexcept { return done_of(strategy_.rest()); }

  /// Runs the execution that the item stands at, writes down how it failed and makes that small.
  [[nodiscard]] Failure tell_failure(const SearchItem& item);

  [[nodiscard]] std::uint64_t states() const noexcept { return strategy_.states(); }

 private:
  [[nodiscard]] SliceEnd search_until(const std::function<bool(const SearchCounts&)>& goes_on,
                                      SearchCounts& counts);

  World& world_;
  const Scenario& scenario_;
  const ProveOptions& options_;
  Explorer explorer_{world_};
  ExhaustiveStrategy strategy_;
};

}  // namespace ltsim
