#include "sim_clock/explore/decision_path.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdio>

#include <fmt/format.h>

namespace ltsim {
namespace {

/// @param text  "3,0,1"
bool parse_order(std::string_view text, Decision& into) {
  while (!text.empty()) {
    std::uint32_t task = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), task);
    if (error != std::errc{} || task >= search_tasks_max || (into.to_try & task_bit(task)) != 0) return false;
    into.must_try(task);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.starts_with(',')) text.remove_prefix(1);
  }
  return true;
}

}  // namespace

void Decision::must_try(std::size_t task) noexcept {
  order[static_cast<std::size_t>(std::popcount(to_try))] = static_cast<std::uint8_t>(task);
  to_try |= task_bit(task);
}

bool Decision::must_try_one_of(TaskBits any) noexcept {
  if (!is_of_tasks) return false;
  if (has_one_of(any)) return true;
  const TaskBits possible = any & enabled;
  if (possible == 0) return false;
  must_try(static_cast<std::size_t>(std::countr_zero(possible)));
  return true;
}

std::optional<std::uint32_t> Decision::next_task() const noexcept {
  const TaskBits left = to_try & ~tried & ~asleep & ~task_bit(chosen);
  if (left == 0) return std::nullopt;
  return *std::find_if(order.begin(), order.end(),
                       [&](std::uint8_t task) { return (left & task_bit(task)) != 0; });
}

bool Decision::has_next() const noexcept {
  if (is_of_tasks) return next_task().has_value();
  return is_of_time ? chosen == 1 : chosen + 1 < count;
}

bool Decision::advance() noexcept {
  if (is_of_tasks) {
    const auto next = next_task();
    tried |= task_bit(chosen);
    if (next) chosen = *next;
    return next.has_value();
  }
  if (!has_next()) return false;
  chosen = is_of_time ? 0 : chosen + 1;
  return true;
}

unsigned Decision::alternatives() const noexcept {
  if (is_of_tasks) return static_cast<unsigned>(std::popcount(to_try & ~asleep));
  return is_of_time ? 2 : count;
}

unsigned Decision::alternatives_before() const noexcept {
  if (is_of_tasks) return static_cast<unsigned>(std::popcount(tried & to_try & ~asleep));
  return is_of_time ? 1 - chosen : chosen;
}

std::string to_string(const Decision& decision) {
  if (!decision.is_of_tasks)
    return fmt::format("{} {} of {}", decision.is_of_time ? "time" : "number", decision.chosen,
                       decision.count);
  std::string order;
  for (int i = 0; i < std::popcount(decision.to_try); ++i)
    order += fmt::format("{}{}", i == 0 ? "" : ",", decision.order[static_cast<std::size_t>(i)]);
  return fmt::format("task {} of {:#x} to-try {} tried {:#x} asleep {:#x}", decision.chosen, decision.enabled,
                     order, decision.tried, decision.asleep);
}

std::optional<Decision> parse_decision(const std::string& line) {
  Decision decision;
  unsigned long long enabled = 0, tried = 0, asleep = 0;
  std::array<char, 3 * search_tasks_max + 1> order{};
  if (std::sscanf(line.c_str(), "task %u of %llx to-try %180[0-9,] tried %llx asleep %llx", &decision.chosen,
                  &enabled, order.data(), &tried, &asleep) == 5) {
    decision.is_of_tasks = true;
    decision.enabled = enabled;
    decision.tried = tried;
    decision.asleep = asleep;
    if (decision.chosen < search_tasks_max && parse_order(order.data(), decision)) return decision;
    return std::nullopt;
  }
  if (std::sscanf(line.c_str(), "time %u of %u", &decision.chosen, &decision.count) == 2) {
    decision.is_of_time = true;
    return decision;
  }
  if (std::sscanf(line.c_str(), "number %u of %u", &decision.chosen, &decision.count) == 2) return decision;
  return std::nullopt;
}

void add_request(std::vector<TreeRequest>& requests, TreeRequest request) {
  const bool is_known = std::any_of(requests.begin(), requests.end(), [&](const TreeRequest& known) {
    return known.decision == request.decision && (known.any & ~request.any) == 0;
  });
  if (!is_known) requests.push_back(request);
}

double done_of(std::span<const Decision> decisions) noexcept {
  double done = 0;
  double share = 1;
  for (const Decision& decision : decisions) {
    const unsigned all = decision.alternatives();
    if (all == 0) continue;
    done += share * decision.alternatives_before() / all;
    share /= all;
  }
  return done;
}

void DecisionPath::begin_item(const SearchItem& item) {
  decisions_.assign(item.decisions.begin(), item.decisions.end());
  settled_ = item.settled;
  requests_.clear();
  steps_in_common_ = 0;
}

Decision& DecisionPath::next(const Decision& as_new) noexcept {
  if (!is_at_end()) {
    const Decision& known = decisions_[at_];
    if (known.is_of_tasks != as_new.is_of_tasks || known.is_of_time != as_new.is_of_time ||
        known.enabled != as_new.enabled || known.count != as_new.count) {
      note_that_runs_differ();
      decisions_.resize(at_);
    }
  }
  if (is_at_end()) {
    decisions_.push_back(as_new);
    Decision& made = decisions_.back();
    if (made.is_of_tasks && (made.enabled & task_bit(made.chosen)) == 0)
      made.chosen = static_cast<std::uint32_t>(std::countr_zero(made.enabled));
  }
  return decisions_[at_++];
}

void DecisionPath::note_that_runs_differ() {
  if (!trouble_.empty()) return;
  trouble_ = fmt::format(
      "an execution that is run again differs at choice {}: a variable of the code under test or of the "
      "scenario survives from one execution to the next",
      at_ + 1);
}

bool DecisionPath::must_try_one_of(std::size_t decision, TaskBits any) {
  Decision& of = decisions_[decision];
  if (decision >= settled_) return of.must_try_one_of(any);
  if (!of.is_of_tasks) return false;
  if (of.has_one_of(any)) return true;
  if ((any & of.enabled) == 0) return false;
  add_request(requests_, {.decision = static_cast<std::uint32_t>(decision), .any = any});
  return true;
}

void DecisionPath::end_execution() {
  if (!is_at_end()) note_that_runs_differ();
}

bool DecisionPath::advance() {
  if (!trouble_.empty()) return false;
  while (decisions_.size() > settled_ && !decisions_.back().advance()) decisions_.pop_back();
  if (decisions_.size() <= settled_) return false;
  // A number is chosen in the middle of a step, which it may make another.
  const Decision& changed = decisions_.back();
  const bool is_between_steps = changed.is_of_tasks || changed.is_of_time || changed.steps == 0;
  steps_in_common_ = changed.steps - (is_between_steps ? 0 : 1);
  return true;
}

}  // namespace ltsim
