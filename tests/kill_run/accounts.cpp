#include "tests/kill_run/accounts.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "protocol/exchange_observer.hpp"
#include "protocol/shared_memory_error.hpp"
#include "tests/kill_run/payload.hpp"

namespace kill_run {

namespace {

using protocol::ExchangeOutcome;

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

/// All that is known of one request.
struct Story {
  Entry submitted;
  bool was_given_up = false;
  std::optional<Entry> ended;
  std::vector<Entry> executing;
};

class Accountant {
 public:
  explicit Accountant(const Evidence& evidence) : evidence_(evidence) {
    for (const Kill& kill : evidence.kills) {
      if (kill.role == Role::kernel) killed_kernels_.insert(kill.incarnation);
    }
  }

  Accounts run() {
    for (const Entry& entry : evidence_.kernel) read_kernel(entry);
    for (const Entry& entry : evidence_.emulator) read_emulator(entry);
    for (const auto& [number, story] : stories_) judge(number, story);
    return std::move(accounts_);
  }

 private:
  void accuse(std::string_view invariant, std::uint64_t request, std::string_view what) {
    accounts_.accusations.push_back(fmt::format("{}: request {} {}", invariant, request, what));
  }

  void read_any(const Entry& entry, std::string_view who) {
    if (entry.event == Event::closed) ++accounts_.tally.closed;
    if (entry.event != Event::open_failed) return;
    const auto error = static_cast<protocol::SharedMemoryError>(entry.detail);
    accounts_.accusations.push_back(
        fmt::format("I17: {} {} could not open: {}", who, entry.incarnation, to_string(error)));
  }

  void read_kernel(const Entry& entry) {
    read_any(entry, "kernel");
    if (entry.event == Event::submitted) {
      ++accounts_.tally.submitted;
      stories_[entry.request].submitted = entry;
      return;
    }
    if (entry.request == 0) return;
    Story& story = stories_[entry.request];
    const auto lasted = entry.time - story.submitted.time;
    const TimeOuts& time_outs = story.submitted.round == 0 ? usual_time_outs : fresh_time_outs;
    if (entry.event == Event::given_up) {
      ++accounts_.tally.given_up;
      story.was_given_up = true;
      if (lasted < time_outs.take + time_outs.answer)
        accuse("I16", entry.request, fmt::format("was given up after {:.3f} ms", milliseconds(lasted)));
    }
    if (entry.event == Event::withdrawn) {
      ++accounts_.tally.withdrawn;
      if (lasted < time_outs.take)
        accuse("I16", entry.request, fmt::format("was withdrawn after {:.3f} ms", milliseconds(lasted)));
    }
    if (entry.event == Event::ended) {
      if (story.ended) accuse("I18", entry.request, "ended twice");
      story.ended = entry;
    }
  }

  void read_emulator(const Entry& entry) {
    read_any(entry, "emulator");
    if (entry.event != Event::executing) return;
    ++accounts_.tally.executed;
    const auto found = stories_.find(entry.request);
    if (found == stories_.end()) {
      accuse("I3", entry.request,
             fmt::format("was executed by emulator {}, yet nobody has submitted it", entry.incarnation));
      return;
    }
    if (entry.digest != found->second.submitted.digest)
      accuse("I3", entry.request,
             fmt::format("was executed by emulator {} with other bytes than it has", entry.incarnation));
    found->second.executing.push_back(entry);
  }

  void judge(std::uint64_t number, const Story& story) {
    if (story.executing.size() > 1) {
      accuse("I5", number,
             fmt::format("was executed {} times, first by emulator {}, last by emulator {}",
                         story.executing.size(), story.executing.front().incarnation,
                         story.executing.back().incarnation));
    }
    if (!story.ended) return judge_without_outcome(number, story);
    const bool is_fresh = story.submitted.round != 0;
    const auto lasted = story.ended->time - story.submitted.time;
    const auto bound = call_bound(is_fresh ? fresh_time_outs : usual_time_outs);
    Tally& tally = accounts_.tally;
    (is_fresh ? tally.fresh_calls : tally.usual_calls).push_back(lasted);
    if (lasted > bound + scheduling_allowance) {
      accuse("I15", number,
             fmt::format("took {:.3f} ms, its time-outs add up to {:.3f} ms", milliseconds(lasted),
                         milliseconds(bound)));
    }
    const auto outcome = static_cast<ExchangeOutcome>(story.ended->detail);
    ++tally.outcomes.at(story.ended->detail);
    if (is_fresh) {
      ++tally.fresh;
      if (outcome != ExchangeOutcome::ok)
        accuse("I17", number, fmt::format("was fresh after a kill and ended as {}", to_string(outcome)));
    }
    judge_outcome(number, story, outcome);
  }

  void judge_without_outcome(std::uint64_t number, const Story& story) {
    ++accounts_.tally.without_outcome;
    if (!story.executing.empty()) ++accounts_.tally.executed_without_outcome;
    const std::uint32_t kernel = story.submitted.incarnation;
    if (!killed_kernels_.contains(kernel)) {
      accuse("I18", number, fmt::format("has no outcome, yet kernel {} was not killed", kernel));
    } else if (!kernels_without_outcome_.insert(kernel).second) {
      accuse("I18", number, fmt::format("has no outcome, and is not the only one of kernel {}", kernel));
    }
  }

  void judge_outcome(std::uint64_t number, const Story& story, ExchangeOutcome outcome) {
    switch (outcome) {
      case ExchangeOutcome::ok:
        if (story.executing.empty()) accuse("I1", number, "was answered and not executed");
        if (story.ended->answered != number) {
          accuse("I1", number, fmt::format("got the answer to request {}", story.ended->answered));
        } else if (story.ended->digest != digest(protocol::fx::as_span(answer_to(number)))) {
          accuse("I4", number, "got an answer with other bytes than were given");
        }
        return;
      case ExchangeOutcome::rejected:
      case ExchangeOutcome::not_executed:
        if (!story.executing.empty()) {
          accuse("I6", number,
                 fmt::format("ended as {}, yet emulator {} has executed it", to_string(outcome),
                             story.executing.front().incarnation));
        }
        return;
      case ExchangeOutcome::unknown:
        if (!story.executing.empty()) ++accounts_.tally.unknown_but_executed;
        if (!story.was_given_up && !an_emulator_died_during(story))
          accuse("I18", number, "ended as unknown, yet it was not given up and no emulator was killed");
        return;
    }
  }

  [[nodiscard]] bool an_emulator_died_during(const Story& story) const {
    return std::ranges::any_of(evidence_.kills, [&story](const Kill& kill) {
      return kill.role == Role::emulator && kill.begin <= story.ended->time &&
             kill.dead >= story.submitted.time;
    });
  }

  Evidence evidence_;
  std::map<std::uint64_t, Story> stories_;
  std::set<std::uint32_t> killed_kernels_;
  std::set<std::uint32_t> kernels_without_outcome_;
  Accounts accounts_;
};

}  // namespace

Accounts account_for(const Evidence& evidence) { return Accountant(evidence).run(); }

}  // namespace kill_run
