#include "sim_clock/explore/minimizer.hpp"

#include <algorithm>
#include <utility>

#include "sim_clock/check/signal_guard.hpp"
#include "sim_clock/explore/anchor_weakness.hpp"
#include "sim_clock/explore/recording_strategy.hpp"
#include "sim_clock/explore/same_failure.hpp"
#include "sim_clock/explore/search_filters.hpp"

namespace ltsim {
namespace {

using namespace std::chrono_literals;

// How far into the budget the stages may go: what comes after the search takes few executions, but it must come.
constexpr double end_of_leaving_out = 0.6;
constexpr double end_of_search = 0.9;
constexpr double end_of_budget = 1.0;

template <typename Line>
std::vector<Line> without(const std::vector<Line>& lines, std::size_t begin, std::size_t end) {
  std::vector<Line> rest;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i < begin || i >= end) rest.push_back(lines[i]);
  }
  return rest;
}

/// Delta debugging: leaves out pieces of something, large ones first, as long as what is left will do.
/// @param size        how many parts it has now
/// @param leave_out   tries it without [begin, end), end may be beyond its size: whether it is shorter now
/// @param has_budget  whether to go on
/// @return            whether each single part was found to be needed
template <typename Size, typename LeaveOut, typename HasBudget>
bool leave_out_pieces(const Size& size, const LeaveOut& leave_out, const HasBudget& has_budget) {
  std::size_t chunk = std::max<std::size_t>(size(), 1);
  while (true) {
    bool shorter = false;
    for (std::size_t begin = 0; begin < size();) {
      if (!has_budget()) return false;
      if (leave_out(begin, begin + chunk)) {
        shorter = true;  // what lies at `begin` now is the next piece
      } else {
        begin += chunk;
      }
    }
    if (chunk == 1 && !shorter) return true;
    if (!shorter || chunk > size()) chunk = std::max<std::size_t>(chunk / 2, 1);
  }
}

bool is_slow_moment(const Deviation& deviation) noexcept {
  return deviation.kind == Deviation::Kind::pass_time || deviation.kind == Deviation::Kind::stall;
}

}  // namespace

MinimizeReport Minimizer::minimize(const Schedule& failing, const MinimizeOptions& options) {
  const SignalGuard signals;
  world_.set_default_memory(failing.memory);
  world_.set_default_cpu(failing.cpu);
  world_.set_findings(failing.findings);
  world_.set_input(failing.input);
  SearchBudget budget{options.executions_max, options.points_max, options.seconds_max};
  budget_ = &budget;
  is_the_failure_ = [&](const Outcome& outcome) { return same_failure(outcome, failing); };
  MinimizeReport report;
  report.schedule = failing;
  // Twice: what is initialised on first use was so when the schedule was recorded.
  static_cast<void>(attempt(failing.deviations));
  if (auto given = attempt(failing.deviations)) {
    report.reproduced = true;
    best_ = std::move(*given);
    leave_out_input();
    leave_out_lines();
    const auto is_alike = [&](const Outcome& outcome) { return alike_failure(outcome, failing); };
    if (join_slow_moments()) leave_out_lines();
    if (!options.numbers_matter) {
      // A hundred lines that say the same number are no use to anybody.
      const auto is_the_same = std::exchange(is_the_failure_, is_alike);
      if (join_slow_moments()) {
        leave_out_lines();
      } else {
        is_the_failure_ = is_the_same;
      }
    }
    report.smallest = search_for_shorter();
    if (!options.numbers_matter) {
      // Only now: a search that may change the numbers could change the bug as well.
      is_the_failure_ = is_alike;
      leave_out_lines();
    }
    strengthen_anchors();
    shrink_magnitudes();
    report.one_minimal = leave_out_lines();
    report.one_minimal = leave_out_input() && report.one_minimal;
    report.schedule.input = world_.input_records();
    report.schedule.deviations = best_.deviations;
    report.schedule.message = one_line(best_.outcome.message);
    report.outcome = best_.outcome;
    report.trace_hash = best_.trace_hash;
    report.at = best_.at;
  }
  report.executions = budget.executions();
  budget_ = nullptr;
  return report;
}

std::optional<Minimizer::Attempt> Minimizer::tried(Tried&& tried) {
  budget_->use(tried.points);
  return std::move(tried.failure);
}

Minimizer::Tried Minimizer::record(Strategy& strategy, AnchorTracker& anchors) {
  AddressRecorder addresses{strategy};
  RecordingStrategy recording{addresses, world_, anchors};
  std::uint64_t hash = 0;
  bool simulable = true;
  try {
    hash = explorer_.execute(scenario_, recording, 0, &anchors);
  } catch (const Explorer::NotSimulable&) {
    simulable = false;
  }
  Tried tried{.failure = std::nullopt, .points = world_.scheduler().points()};
  const Outcome& outcome = world_.scheduler().outcome();
  if (simulable && !outcome.passed() && is_the_failure_(outcome)) {
    tried.failure = Attempt{.deviations = recording.deviations(),
                            .addressed = addresses.deviations(),
                            .outcome = outcome,
                            .trace_hash = hash,
                            .at = world_.now()};
  }
  return tried;
}

std::optional<Minimizer::Attempt> Minimizer::attempt(const std::vector<Deviation>& deviations) {
  return tried(explorer_.apart<Tried>([&] {
    AnchorTracker anchors{world_, nullptr};
    ReplayStrategy replay{deviations, world_, anchors};
    return record(replay, anchors);
  }));
}

std::optional<Minimizer::Attempt> Minimizer::attempt(const AddressedSchedule& addressed) {
  const auto recorded = tried(explorer_.apart<Tried>([&] {
    AnchorTracker anchors{world_, nullptr};
    AddressedStrategy strategy;
    strategy.set_deviations(addressed);
    return record(strategy, anchors);
  }));
  if (!recorded) return std::nullopt;
  auto replayed = attempt(recorded->deviations);
  if (!replayed || replayed->trace_hash != recorded->trace_hash) return std::nullopt;
  return replayed;
}

bool Minimizer::leave_out_lines() {
  return leave_out_pieces(
      [this] { return best_.deviations.size(); },
      [this](std::size_t begin, std::size_t end) {
        auto rest = attempt(without(best_.deviations, begin, end));
        if (!rest || rest->deviations.size() >= best_.deviations.size()) return false;
        best_ = std::move(*rest);
        return true;
      },
      [this] { return has_budget(best_.deviations.size() > 16 ? end_of_leaving_out : end_of_budget); });
}

bool Minimizer::leave_out_input() {
  const auto records = [this]() -> const std::vector<std::string>& { return world_.input_records(); };
  const auto leave_out = [&] {
    return leave_out_pieces([&] { return records().size(); },
                            [&](std::size_t begin, std::size_t end) {
                              return still_fails_with_input(without(records(), begin, end));
                            },
                            [this] { return has_budget(end_of_leaving_out); });
  };
  if (records().empty()) return true;
  static_cast<void>(leave_out());
  for (std::size_t i = 0; i < records().size(); ++i) {
    static_cast<void>(leave_out_pieces([&] { return records()[i].size(); },
                                       [&](std::size_t begin, std::size_t end) {
                                         std::vector<std::string> changed = records();
                                         changed[i].erase(begin, std::min(end, changed[i].size()) - begin);
                                         return !changed[i].empty() &&
                                                still_fails_with_input(std::move(changed));
                                       },
                                       [this] { return has_budget(end_of_leaving_out); }));
  }
  return leave_out();
}

bool Minimizer::still_fails_with_input(std::vector<std::string> records) {
  std::vector<std::string> before = world_.input_records();
  world_.set_input(std::move(records));
  auto found = attempt(best_.deviations);
  if (found && found->deviations.size() <= best_.deviations.size()) {
    best_ = std::move(*found);
    return true;
  }
  world_.set_input(std::move(before));
  return false;
}

bool Minimizer::join_slow_moments() {
  const auto lets_all_wait = [](const Deviation& line) { return line.kind == Deviation::Kind::pass_time; };
  std::vector<Deviation> others = best_.deviations;
  std::erase_if(others, lets_all_wait);
  if (best_.deviations.size() - others.size() < 2) return false;
  auto watched = explorer_.apart<Tried>([&] {
    AnchorTracker anchors{world_, nullptr};
    ReplayStrategy replay{best_.deviations, world_, anchors};
    SilenceWatch watch{replay, anchors};
    Tried tried = record(watch, anchors);
    tried.silences = watch.silences();
    return tried;
  });
  const auto silences = std::move(watched.silences);
  if (!tried(std::move(watched))) return false;
  // The steps between the moments took time as well; a silence that ends in the middle of one ends surely after the
  // last look of a peer that polls.
  for (const unsigned halves : {1U, 0U, 2U}) {
    if (!has_budget(end_of_leaving_out)) return false;
    std::vector<Deviation> changed = others;
    for (const SilenceWatch::Silence& silence : silences) {
      for (const std::string& place : silence.held_up_at) {
        Deviation stall;
        stall.kind = Deviation::Kind::stall;
        stall.anchor = place;
        stall.passes = silence.passed + halves * silence.shortest / 2;
        changed.push_back(std::move(stall));
      }
    }
    auto found = attempt(changed);
    if (!found || found->deviations.size() >= best_.deviations.size()) continue;
    best_ = std::move(*found);
    return true;
  }
  return false;
}

bool Minimizer::search_for_shorter() {
  const auto accept = [this](const AddressedSchedule& found) {
    auto shorter = attempt(found);
    if (!shorter || shorter->deviations.size() >= best_.deviations.size()) return false;
    best_ = std::move(*shorter);
    return true;
  };
  ScheduleSearch search{explorer_, world_, scenario_, is_the_failure_, accept, *budget_};
  // A stage that comes to no end leaves half of the rest to the others.
  const auto half_of_the_rest = [this] { return (budget_->used() + end_of_search) / 2; };
  const auto deepen = [&](const SearchFilter& filter, ScheduleSearch::Equivalence equivalence, double until) {
    if (best_.deviations.empty()) return true;
    const auto end = search.deepen(filter, best_.deviations.size() - 1, equivalence, until);
    return end != ScheduleSearch::End::out_of_budget;  // what is found first is the smallest
  };
  // Many lines mostly stand for few: deepening to their number would never come to an end.
  constexpr std::size_t many = 4;
  constexpr std::size_t few = 2;
  if (best_.deviations.size() > many) {
    static_cast<void>(search.deepen(silences_filter(best_.addressed), few,
                                    ScheduleSearch::Equivalence::causal, half_of_the_rest()));
  }
  for (const Breadth breadth : {Breadth::own_choices, Breadth::own_kinds, Breadth::everything}) {
    deepen(search_filter(breadth, best_.addressed), ScheduleSearch::Equivalence::causal, half_of_the_rest());
    while (best_.deviations.size() > 2 &&
           search.exchange(best_.addressed, search_filter(breadth, best_.addressed), half_of_the_rest()) ==
               ScheduleSearch::End::found) {
      leave_out_lines();
    }
  }
  return deepen(search_filter(Breadth::everything, best_.addressed), ScheduleSearch::Equivalence::exact,
                end_of_search);
}

void Minimizer::strengthen_anchors() {
  for (std::size_t line = 0; line < best_.deviations.size() && has_budget(end_of_budget); ++line) {
    if (anchor_weakness(best_.deviations[line].anchor) != 0) strengthen_anchor(line);
  }
}

void Minimizer::strengthen_anchor(std::size_t line) {
  const AddressedDeviation moved = best_.addressed[line];
  AddressedSchedule others = best_.addressed;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(line));
  SearchFilter filter = search_filter(Breadth::own_choices, {moved});
  ScheduleSearch search{explorer_, world_, scenario_, is_the_failure_, {}, *budget_};
  std::vector<AddressedDeviation> places = search.alternatives(others, filter, true);
  // The same choice at another moment of the same task.
  std::erase_if(places, [&](const AddressedDeviation& place) {
    return place.at.question != moved.at.question || place.at.whose != moved.at.whose ||
           place.value != moved.value || place.slow.duration != moved.slow.duration ||
           place.slow.others_go_on != moved.slow.others_go_on;
  });
  const auto distance = [&](const AddressedDeviation& place) {
    return place.at.ordinal > moved.at.ordinal ? place.at.ordinal - moved.at.ordinal
                                               : moved.at.ordinal - place.at.ordinal;
  };
  std::sort(places.begin(), places.end(), [&](const auto& a, const auto& b) {
    return std::pair{distance(a), a.at.ordinal} < std::pair{distance(b), b.at.ordinal};
  });
  constexpr std::size_t places_max = 64;
  if (places.size() > places_max) places.resize(places_max);
  unsigned weakest = anchor_weakness(best_.deviations[line].anchor);
  for (const AddressedDeviation& place : places) {
    if (weakest == 0 || !has_budget(end_of_budget)) return;
    AddressedSchedule changed = others;
    changed.push_back(place);
    auto found = attempt(changed);
    if (!found || found->deviations.size() != best_.deviations.size()) continue;
    const auto same_place = [&](const AddressedDeviation& deviation) { return deviation.at == place.at; };
    const auto at = std::find_if(found->addressed.begin(), found->addressed.end(), same_place);
    if (at == found->addressed.end()) continue;
    const auto index = static_cast<std::size_t>(at - found->addressed.begin());
    const unsigned weakness = anchor_weakness(found->deviations[index].anchor);
    // Passing another line would change which line the next one to be looked at is.
    if (weakness >= weakest || index != line) continue;
    weakest = weakness;
    best_ = std::move(*found);
  }
}

void Minimizer::shrink_magnitudes() {
  for (std::size_t line = 0; line < best_.deviations.size(); ++line) {
    const Deviation given = best_.deviations[line];
    Deviation changed = given;
    if (is_slow_moment(given)) {
      shrink_duration(line);
    } else if (given.kind == Deviation::Kind::choose || given.kind == Deviation::Kind::older) {
      for (changed.answer = 1; changed.answer < given.answer; ++changed.answer) {
        if (!has_budget(end_of_budget) || still_fails_with(line, changed)) break;
      }
    }
  }
}

void Minimizer::shrink_duration(std::size_t line) {
  const Attempt as_given = best_;
  std::optional<Attempt> smallest;
  Deviation changed = as_given.deviations[line];
  // Rather a round one that is a little longer than one such as 131072us.
  const SimTime longest = 2 * changed.passes;
  for (const SimTime duration : round_durations) {
    if (duration > longest || !has_budget(end_of_budget)) break;
    changed.passes = duration;
    best_ = as_given;
    if (!still_fails_with(line, changed)) continue;
    if (!smallest) smallest = best_;
    // After a rebuild things take a few steps more or less: on the edge the failure would be gone.
    const Attempt candidate = best_;
    changed.passes = duration - std::min<SimTime>(duration / 4, 1us);
    if (!still_fails_with(line, changed)) continue;
    best_ = candidate;
    return;
  }
  best_ = smallest.value_or(as_given);
}

bool Minimizer::still_fails_with(std::size_t line, const Deviation& changed) {
  std::vector<Deviation> deviations = best_.deviations;
  deviations[line] = changed;
  auto found = attempt(deviations);
  if (!found || found->deviations.size() != deviations.size()) return false;
  best_ = std::move(*found);
  return true;
}

}  // namespace ltsim
