#include "sim_clock/explore/search_runner.hpp"

namespace ltsim {

SearchRunner::SearchRunner(World& world, const Scenario& scenario, const ProveOptions& options)
    : world_(world), scenario_(scenario), options_(options), strategy_(world, options.bounds) {
  world_.coverage().forget();
  world_.set_default_memory(options.memory);
  world_.set_default_cpu(Cpu::many);
  world_.set_findings(options.findings);
}

void SearchRunner::warm_up() {
  ExhaustiveStrategy first{world_, {}};
  static_cast<void>(explorer_.execute(scenario_, first, 0, nullptr));
  if (options_.bounds.states && world_.memory() == Memory::c11)
    throw Explorer::NotSimulable{
        "states are told apart with memory sc only: what of the past a weak memory "
        "still shows is no part of them"};
  if (world_.scheduler().cpu() != Cpu::many)
    throw Explorer::NotSimulable{"the scenario has one processor: which orders matter there, is not known"};
}

SearchedSlice SearchRunner::search(const SearchItem& item,
                                   const std::function<bool(const SearchCounts&)>& goes_on) {
  strategy_.begin_item(item);
  SearchedSlice slice;
  try {
    slice.end = search_until(goes_on, slice.counts);
  } catch (const Explorer::NotSimulable& trouble) {
    slice.end = SliceEnd::in_error;
    slice.error = trouble.message;
  }
  slice.requests = strategy_.requests();
  slice.rest.assign(strategy_.rest().begin(), strategy_.rest().end());
  return slice;
}

SliceEnd SearchRunner::search_until(const std::function<bool(const SearchCounts&)>& goes_on,
                                    SearchCounts& counts) {
  for (;;) {
    static_cast<void>(explorer_.execute(scenario_, strategy_, 0, nullptr));
    if (!strategy_.trouble().empty()) throw Explorer::NotSimulable{strategy_.trouble()};
    counts.points += world_.scheduler().points();
    if (strategy_.was_redundant()) {
      ++counts.redundant;
    } else {
      ++counts.executions;
      if (strategy_.was_cut_off()) ++counts.cut_off;
      if (strategy_.was_held_back()) ++counts.held_back;
    }
    if (!world_.scheduler().outcome().passed()) return SliceEnd::failed;
    const bool is_more_left = strategy_.advance();
    if (!strategy_.trouble().empty()) throw Explorer::NotSimulable{strategy_.trouble()};
    if (!is_more_left) return SliceEnd::over;
    if (!goes_on(counts)) return SliceEnd::stopped;
  }
}

Failure SearchRunner::tell_failure(const SearchItem& item) {
  strategy_.begin_item(item);
  Failure failure = explorer_.record(scenario_, strategy_, 0);
  failure.count = 1;
  ExploreOptions small;
  small.memory = options_.memory;
  small.findings = options_.findings;
  small.minimize_seconds = options_.minimize_seconds;
  std::vector<Failure> failures;
  static_cast<void>(explorer_.add_failure(scenario_, small, failures, std::move(failure)));
  return std::move(failures.front());
}

}  // namespace ltsim
