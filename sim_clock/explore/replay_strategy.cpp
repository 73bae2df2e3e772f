#include "sim_clock/explore/replay_strategy.hpp"

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

std::size_t ReplayStrategy::choose(ChoiceKind kind, std::span<const std::uint64_t> options) noexcept {
  Entry* const entry =
      entry_here(kind == ChoiceKind::task ? Deviation::Kind::switch_task : Deviation::Kind::choose);
  if (entry == nullptr) return 0;
  for (std::size_t i = 0; i < options.size(); ++i) {
    const bool meant =
        kind == ChoiceKind::task
            ? world_.scheduler().task(static_cast<TaskId>(options[i])).name == entry->deviation->to_task
            : i == entry->deviation->answer;
    if (!meant) continue;
    entry->carried_out = true;
    return i;
  }
  return 0;
}

SlowMoment ReplayStrategy::slow_moment(SimTime /*until_next_timer*/) noexcept {
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
    const std::string_view reason = !entry.reached ? "the execution never came to this place"
                                    : entry.deviation->kind == Deviation::Kind::switch_task
                                        ? "the task cannot run there"
                                        : "there is no such answer";
    return Divergence{.deviation = entry.deviation, .reason = std::string{reason}};
  }
  return std::nullopt;
}

ReplayStrategy::Entry* ReplayStrategy::entry_here(Deviation::Kind kind) noexcept {
  const auto found = entries_at_.find(anchors_.anchor());
  if (found == entries_at_.end()) return nullptr;
  for (const std::size_t index : found->second) {
    Entry& entry = entries_[index];
    if (entry.deviation->kind != kind || entry.reached) continue;
    entry.reached = true;
    return &entry;
  }
  return nullptr;
}

}  // namespace ltsim
