#include "tests/scenarios/area_ownership.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace scenarios {
namespace {

using Use = AreaOwnership::Use;

bool writes(Use use) noexcept { return use == Use::writes_request || use == Use::writes_response; }
bool is_of_request(Use use) noexcept { return use == Use::writes_request || use == Use::reads_request; }

bool conflict(Use one, Use other) noexcept {
  return is_of_request(one) == is_of_request(other) && (writes(one) || writes(other));
}

std::string_view to_string(Use use) noexcept {
  switch (use) {
    case Use::writes_request:
      return "writes the request";
    case Use::reads_request:
      return "reads the request";
    case Use::writes_response:
      return "writes the response";
    case Use::reads_response:
      return "reads the response";
  }
  return "";
}

}  // namespace

void AreaOwnership::enters(ltsim::TaskId task, Use use) {
  leaves(task);
  forget_killed();
  Visit visit{.task = task, .use = use};
  for (Visit& other : visits_) {
    const ltsim::Task& there = world_.scheduler().task(other.task);
    if (!conflict(use, other.use)) continue;
    visit.disturbed = other.disturbed = true;
    if (first_conflict_) continue;
    first_conflict_ = fmt::format("{} {} while {} {}", world_.scheduler().task(task).name, to_string(use),
                                  there.name, to_string(other.use));
  }
  visits_.insert(std::ranges::find_if(visits_, [&](const Visit& other) { return other.task > task; }), visit);
}

void AreaOwnership::forget_killed() noexcept {
  for (std::size_t i = visits_.size(); i-- != 0;) {
    if (world_.scheduler().task(visits_[i].task).state == ltsim::Task::State::killed) leaves(visits_[i].task);
  }
}

void AreaOwnership::leaves(ltsim::TaskId task) noexcept {
  const auto visit = std::ranges::find(visits_, task, &Visit::task);
  if (visit == visits_.end()) return;
  std::move(visit + 1, visits_.end(), visit);
  visits_.back() = {};  // what is left over there would make two states of one
  visits_.pop_back();
}

bool AreaOwnership::is_disturbed(ltsim::TaskId task) const noexcept {
  const auto visit = std::ranges::find(visits_, task, &Visit::task);
  return visit != visits_.end() && visit->disturbed;
}

}  // namespace scenarios
