#include "sim_clock/explore/replay_strategy.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {

ReplayStrategy::ReplayStrategy(const std::vector<Deviation>& deviations, const World& world,
                               const AnchorTracker& anchors)
    : world_(world), anchors_(anchors) {
  entries_.reserve(deviations.size());
  for (const Deviation& deviation : deviations) {
    entries_at_[deviation.anchor].push_back(entries_.size());
    entries_.push_back(Entry{.deviation = &deviation});
  }
}

void ReplayStrategy::begin_execution(std::uint64_t /*seed*/) noexcept {
  for (Entry& entry : entries_) entry = Entry{.deviation = entry.deviation};
}

std::size_t ReplayStrategy::choose_task(const TaskChoice& choice) noexcept {
  Entry* const entry = entry_here(Deviation::Kind::switch_task);
  if (entry == nullptr) return 0;
  for (std::size_t i = 0; i < choice.options.size(); ++i) {
    if (world_.scheduler().task(static_cast<TaskId>(choice.options[i])).name != entry->deviation->to_task)
      continue;
    entry->carried_out = true;
    return i;
  }
  return 0;
}

std::size_t ReplayStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  Entry* const entry = entry_here(Deviation::Kind::fault, kind);
  if (entry == nullptr) return 0;
  const std::size_t variant = kind == FaultKind::crash ? crash_of(entry->deviation->process, variants_count)
                                                       : entry->deviation->answer;
  if (variant == 0 || variant > variants_count) return 0;
  entry->carried_out = true;
  return variant;
}

std::size_t ReplayStrategy::crash_of(std::string_view process, std::size_t variants_count) const {
  for (std::size_t variant = 1; variant <= variants_count; ++variant) {
    std::string name = world_.process_name(world_.faults().crash_candidate(variant));
    make_one_word(name);
    if (name == process) return variant;
  }
  return 0;
}

std::size_t ReplayStrategy::answer(std::size_t count) noexcept {
  Entry* const entry = entry_here(Deviation::Kind::choose);
  if (entry == nullptr || entry->deviation->answer >= count) return 0;
  entry->carried_out = true;
  return entry->deviation->answer;
}

std::size_t ReplayStrategy::choose_age(const AgeChoice& choice) noexcept {
  Entry* const entry = entry_here(Deviation::Kind::older);
  if (entry == nullptr) return 0;
  const auto found = std::find(choice.ages.begin(), choice.ages.end(), entry->deviation->answer);
  if (found == choice.ages.end()) return 0;
  entry->carried_out = true;
  return static_cast<std::size_t>(found - choice.ages.begin());
}

SlowMoment ReplayStrategy::slow_moment(const SlowMomentChoice& /*choice*/) noexcept {
  for (const auto kind : {Deviation::Kind::pass_time, Deviation::Kind::stall}) {
    Entry* const entry = entry_here(kind);
    if (entry == nullptr) continue;
    entry->carried_out = true;
    return {.duration = entry->deviation->passes, .others_go_on = kind == Deviation::Kind::stall};
  }
  return {};
}

std::optional<ReplayStrategy::Divergence> ReplayStrategy::divergence() const {
  for (const Entry& entry : entries_) {
    if (entry.carried_out) continue;
    const std::string_view reason =
        !entry.reached                                          ? "the execution never came to this place"
        : entry.deviation->kind == Deviation::Kind::switch_task ? "the task cannot run there"
        : entry.deviation->kind == Deviation::Kind::older
            ? "memory allows no store there that is so much older"
        : entry.deviation->kind != Deviation::Kind::fault ? "there is no such answer"
        : entry.deviation->fault == FaultKind::crash      ? "the process does not run there"
                                                          : "the fault cannot strike there so";
    return Divergence{.deviation = entry.deviation, .reason = std::string{reason}};
  }
  return std::nullopt;
}

ReplayStrategy::Entry* ReplayStrategy::entry_here(Deviation::Kind kind, FaultKind fault) noexcept {
  const auto found = entries_at_.find(anchors_.anchor());
  if (found == entries_at_.end()) return nullptr;
  for (const std::size_t index : found->second) {
    Entry& entry = entries_[index];
    if (entry.deviation->kind != kind || entry.reached) continue;
    if (kind == Deviation::Kind::fault && entry.deviation->fault != fault) continue;
    entry.reached = true;
    return &entry;
  }
  return nullptr;
}

}  // namespace ltsim
