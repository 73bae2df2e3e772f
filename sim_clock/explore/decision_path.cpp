#include "sim_clock/explore/decision_path.hpp"

#include <algorithm>
#include <bit>
#include <cstdio>

#include <fmt/format.h>

namespace ltsim {

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

void DecisionPath::end_execution() {
  if (!is_at_end()) note_that_runs_differ();
}

bool DecisionPath::advance() {
  if (!trouble_.empty()) return false;
  while (!decisions_.empty()) {
    Decision& last = decisions_.back();
    if (last.is_of_tasks) {
      last.tried |= task_bit(last.chosen);
      const TaskBits left = last.to_try & ~last.tried & ~last.asleep;
      if (left != 0) {
        last.chosen = static_cast<std::uint32_t>(std::countr_zero(left));
        break;
      }
    } else if (last.is_of_time) {
      if (last.chosen == 1) {
        last.chosen = 0;
        break;
      }
    } else if (last.chosen + 1 < last.count) {
      ++last.chosen;
      break;
    }
    decisions_.pop_back();
  }
  if (decisions_.empty()) return false;
  // A number is chosen in the middle of a step, which it may make another.
  const Decision& changed = decisions_.back();
  const bool is_between_steps = changed.is_of_tasks || changed.is_of_time || changed.steps == 0;
  steps_in_common_ = changed.steps - (is_between_steps ? 0 : 1);
  return true;
}

double DecisionPath::done() const noexcept {
  double done = 0;
  double share = 1;
  for (const Decision& decision : decisions_) {
    double all = 2;
    double before = 0;
    if (decision.is_of_tasks) {
      all = std::popcount(decision.to_try & ~decision.asleep);
      before = std::popcount(decision.tried & decision.to_try);
    } else if (decision.is_of_time) {
      before = decision.chosen == 1 ? 0 : 1;
    } else {
      all = decision.count;
      before = decision.chosen;
    }
    if (all < 1) continue;
    done += share * before / all;
    share /= all;
  }
  return done;
}

std::string DecisionPath::checkpoint() const {
  std::string text;
  for (const Decision& decision : decisions_) {
    if (decision.is_of_tasks) {
      text += fmt::format("task {} of {:#x} to-try {:#x} tried {:#x} asleep {:#x}\n", decision.chosen,
                          decision.enabled, decision.to_try, decision.tried, decision.asleep);
    } else {
      text += fmt::format("{} {} of {}\n", decision.is_of_time ? "time" : "number", decision.chosen,
                          decision.count);
    }
  }
  return text;
}

bool DecisionPath::resume(std::string_view checkpoint) {
  decisions_.clear();
  while (!checkpoint.empty()) {
    const std::string line{checkpoint.substr(0, checkpoint.find('\n'))};
    checkpoint.remove_prefix(std::min(line.size() + 1, checkpoint.size()));
    Decision decision;
    unsigned long long enabled = 0, to_try = 0, tried = 0, asleep = 0;
    if (std::sscanf(line.c_str(), "task %u of %llx to-try %llx tried %llx asleep %llx", &decision.chosen,
                    &enabled, &to_try, &tried, &asleep) == 5) {
      decision.is_of_tasks = true;
      decision.enabled = enabled;
      decision.to_try = to_try;
      decision.tried = tried;
      decision.asleep = asleep;
    } else if (std::sscanf(line.c_str(), "time %u of %u", &decision.chosen, &decision.count) == 2) {
      decision.is_of_time = true;
    } else if (std::sscanf(line.c_str(), "number %u of %u", &decision.chosen, &decision.count) != 2) {
      return false;
    }
    decisions_.push_back(decision);
  }
  steps_in_common_ = 0;
  return true;
}

}  // namespace ltsim
