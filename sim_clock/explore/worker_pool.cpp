#include "sim_clock/explore/worker_pool.hpp"

#include <poll.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <deque>
#include <limits>

#include <fmt/format.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/explore/hash_set.hpp"
#include "sim_clock/explore/same_failure.hpp"
#include "sim_clock/explore/worker_message.hpp"
#include "sim_clock/explore/worker_process.hpp"

namespace ltsim {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// How often the parent looks. A worker has room for the records of several times as long.
constexpr std::chrono::milliseconds look_interval{20};
/// What an execution under way gets to end in after the user has asked to stop.
constexpr std::chrono::seconds stop_grace{1};
/// Processes of a share in a row that die before they have begun an execution: something else is wrong then.
constexpr unsigned idle_deaths_max = 3;
/// LTSIM_CHECK ends a process with this exit code.
constexpr int self_check_exit_code = 3;

/// Why the parent killed a process.
enum class KilledFor : std::uint8_t { nothing, hanging, stopping };

/// One worker's part of the executions, and the process that is at it.
struct Share {
  Share(WorkerOrder first_order, WorkerProgress& own) : order(first_order), progress(own) {}

  WorkerOrder order;
  WorkerProgress& progress;
  std::optional<WorkerProcess> process;  ///< none: nothing is left to do
  WorkerMessageReader messages;          ///< of the process
  bool said_its_last = false;            ///< the process has sent the message that ends its work
  KilledFor killed_for = KilledFor::nothing;
  unsigned idle_deaths_count = 0;
  std::vector<Failure> failures;      ///< of all its processes so far
  std::vector<std::uint64_t> counts;  ///< of records that name each
  std::uint64_t seen_ended = 0;
  std::uint64_t seen_position = 0;
  Clock::time_point moved_at;  ///< when these were seen to change
  Clock::time_point asked_at;  ///< for its position

  /// The execution under way or, between two, the next.
  [[nodiscard]] std::uint64_t current() const noexcept { return order.execution_of(progress.ended.load()); }
  [[nodiscard]] bool is_under_way() const noexcept { return progress.begun.load() != progress.ended.load(); }
};

std::uint64_t last_execution(const ExploreOptions& options) {
  constexpr std::uint64_t for_ever = std::numeric_limits<std::uint64_t>::max() / 2;
  return std::min(options.executions_max, for_ever);
}

class WorkerPool {
 public:
  WorkerPool(const Scenario& scenario, const StrategyFactory& make_strategy, const ExploreOptions& options,
             const WorkerPoolOptions& pool)
      : options_(options), pool_(pool), progress_(pool.jobs, last_execution(options)) {
    for (unsigned number = 0; number < pool.jobs; ++number) {
      shares_.emplace_back(WorkerOrder{.scenario = scenario,
                                       .make_strategy = make_strategy,
                                       .options = options,
                                       .number = number,
                                       .workers_count = pool.jobs},
                           progress_.worker(number));
    }
  }

  WorkerPoolReport run() {
    for (Share& share : shares_) {
      if (is_any_left(share)) start(share);
    }
    while (is_any_at_work()) {
      wait_for_messages();
      for (Share& share : shares_) {
        if (share.process) listen(share);
      }
      take_records();
      for (Share& share : shares_) {
        if (share.process) watch(share);
      }
      stop_when_asked();
    }
    take_records();
    return std::move(*this).report();
  }

 private:
  [[nodiscard]] Seconds elapsed() const { return Clock::now() - began_at_; }
  [[nodiscard]] bool is_stopping() const { return progress_.bounds().stop.load(); }

  [[nodiscard]] bool is_any_left(const Share& share) const {
    return share.current() <= progress_.bounds().execution_last.load() && !is_stopping();
  }

  [[nodiscard]] bool is_any_at_work() const {
    return std::any_of(shares_.begin(), shares_.end(),
                       [](const Share& share) { return share.process.has_value(); });
  }

  void start(Share& share) {
    share.said_its_last = false;
    share.killed_for = KilledFor::nothing;
    share.order.failures_sent = share.failures.size();
    share.moved_at = share.asked_at = Clock::now();
    share.messages = {};
    share.process.emplace([&](int socket) { run_worker(share.order, progress_, socket); });
  }

  void wait_for_messages() {
    std::vector<pollfd> descriptors;
    for (const Share& share : shares_) {
      if (share.process)
        descriptors.push_back({.fd = share.process->descriptor(), .events = POLLIN, .revents = 0});
    }
    Seconds wait = look_interval;
    if (options_.seconds_max && !is_stopping())
      wait = std::clamp(*options_.seconds_max - elapsed(), Seconds{0}, wait);
    // A signal ends the wait, and is then asked for by on_progress.
    poll(descriptors.data(), descriptors.size(),
         static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(wait).count()));
  }

  void listen(Share& share) {
    share.messages.add(share.process->receive());
    while (auto message = share.messages.next()) {
      if (auto* const found = std::get_if<WorkerFoundFailure>(&*message)) {
        if (share.failures.size() < found->place) share.failures.resize(found->place);
        share.failures[found->place - 1] = std::move(found->failure);
        continue;
      }
      share.said_its_last = true;
      if (auto* const gave_up = std::get_if<WorkerGaveUp>(&*message)) {
        progress_.bounds().end_at(gave_up->execution);
        errors_.push_back(std::move(*gave_up));
      }
    }
    if (!share.process->has_ended()) return;
    const int status = share.process->wait();
    share.process.reset();
    if (share.said_its_last) return;
    note_death(share, status);
    if (is_any_left(share)) start(share);
  }

  void note_death(Share& share, int status) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == self_check_exit_code) {
      give_up(share, "a worker process contradicted itself");
    } else if (!share.is_under_way()) {
      if (++share.idle_deaths_count == idle_deaths_max)
        give_up(share, fmt::format("worker processes end before they do anything: {}", describe_end(status)));
    } else if (!share.failures.empty() && share.failures.back().execution == share.current()) {
      // It had told what it found, and was making it small.
      add_record(share, {.failure = share.failures.size()});
    } else if (share.killed_for == KilledFor::stopping) {
      abandoned_.push_back(share.current());
    } else if (share.killed_for == KilledFor::hanging) {
      add_death(share, OutcomeKind::livelock,
                fmt::format("no scheduling point for {} s", pool_.hang_after.count()));
    } else {
      add_death(share, OutcomeKind::crash, fmt::format("worker {}", describe_end(status)));
    }
  }

  /// The execution under way counts, with this outcome.
  void add_death(Share& share, OutcomeKind kind, std::string message) {
    share.idle_deaths_count = 0;
    const std::uint64_t execution = share.current();
    Failure failure;
    failure.outcome = {.kind = kind, .message = std::move(message)};
    failure.execution = execution;
    failure.seed = Explorer::seed_of(options_.seed, execution);
    failure.schedule.scenario = share.order.scenario.name;
    failure.schedule.outcome = kind;
    failure.schedule.message = failure.outcome.message;
    failure.has_schedule = false;
    share.failures.push_back(std::move(failure));
    add_record(share, {.failure = share.failures.size()});
    if (!options_.keep_going) progress_.bounds().end_at(execution);
  }

  /// In place of the process that died.
  static void add_record(Share& share, const ExecutionResult& record) {
    const std::uint64_t ended = share.progress.ended.load();
    share.progress.record(ended) = record;
    share.progress.ended.store(ended + 1);
  }

  void give_up(const Share& share, std::string message) {
    errors_.push_back({.execution = share.current(), .message = std::move(message)});
    progress_.bounds().stop.store(true);
  }

  /// Takes the records of all executions that are known to count: nothing can end the exploration before them
  /// any more.
  void take_records() {
    std::uint64_t counts_up_to = progress_.bounds().execution_last.load();
    for (const Share& share : shares_) {
      if (share.process && !options_.keep_going) counts_up_to = std::min(counts_up_to, share.current() - 1);
    }
    for (Share& share : shares_) {
      std::uint64_t taken = share.progress.taken.load();
      const std::uint64_t ended = share.progress.ended.load();
      for (; taken < ended && share.order.execution_of(taken) <= counts_up_to; ++taken)
        take(share, share.progress.record(taken));
      share.progress.taken.store(taken);
    }
  }

  void take(Share& share, const ExecutionResult& record) {
    ++explored_.executions;
    explored_.decisions += record.decisions;
    explored_.points += record.points;
    if (record.failure != 0) {
      if (share.counts.size() < record.failure) share.counts.resize(record.failure, 0);
      ++share.counts[record.failure - 1];
    }
    if (record.trace_hash != 0) traces_.insert(record.trace_hash);  // who died has left no trace
  }

  /// Kills a process that hangs, or that does not end although the user wants to stop.
  void watch(Share& share) {
    const auto now = Clock::now();
    const std::uint64_t ended = share.progress.ended.load();
    const std::uint64_t position = share.progress.position.load();
    if (ended != share.seen_ended || position != share.seen_position || !share.is_under_way()) {
      share.seen_ended = ended;
      share.seen_position = position;
      share.moved_at = share.asked_at = now;
    } else if (now - share.moved_at >= pool_.hang_after) {
      kill(share, KilledFor::hanging);
    } else if (now - share.asked_at >= pool_.hang_after / 8) {
      share.process->signal(worker_position_signal);
      share.asked_at = now;
    }
    if (stop_asked_at_ && now - *stop_asked_at_ >= stop_grace) kill(share, KilledFor::stopping);
  }

  static void kill(Share& share, KilledFor reason) {
    if (share.killed_for != KilledFor::nothing) return;
    share.killed_for = reason;
    share.process->signal(SIGKILL);
  }

  void stop_when_asked() {
    if (options_.seconds_max && elapsed() >= *options_.seconds_max) progress_.bounds().stop.store(true);
    if (!pool_.on_progress || stop_asked_at_) return;
    ExploreProgress so_far{.elapsed = elapsed()};
    for (const Share& share : shares_) {
      so_far.executions += share.progress.ended.load();
      so_far.failures += share.failures.size();
    }
    if (pool_.on_progress(so_far)) return;
    stop_asked_at_ = Clock::now();
    progress_.bounds().stop.store(true);
  }

  WorkerPoolReport report() && {
    explored_.failures = failures_that_count();
    explored_.seconds = elapsed().count();
    explored_.distinct_schedules = traces_.size();
    WorkerPoolReport report{.explored = std::move(explored_),
                            .error = std::nullopt,
                            .stopped = stop_asked_at_.has_value(),
                            .abandoned = std::move(abandoned_)};
    const auto first_error = std::min_element(
        errors_.begin(), errors_.end(),
        [](const WorkerGaveUp& a, const WorkerGaveUp& b) { return a.execution < b.execution; });
    // One worker may have come to an error after the failure at which another has ended the exploration.
    if (first_error != errors_.end() && first_error->execution <= progress_.bounds().execution_last.load()) {
      report.error = std::move(first_error->message);
    }
    return report;
  }

  /// Each different one once, by its first execution.
  [[nodiscard]] std::vector<Failure> failures_that_count() {
    std::vector<Failure> all;
    for (Share& share : shares_) {
      share.counts.resize(share.failures.size(), 0);
      for (std::size_t i = 0; i < share.failures.size(); ++i) {
        Failure& failure = share.failures[i];
        failure.count = share.counts[i];
        if (failure.count != 0) all.push_back(std::move(failure));
      }
    }
    std::sort(all.begin(), all.end(),
              [](const Failure& a, const Failure& b) { return a.execution < b.execution; });
    std::vector<Failure> different;
    for (Failure& failure : all) {
      const auto known = std::find_if(different.begin(), different.end(),
                                      [&](const Failure& other) { return is_same_failure(other, failure); });
      if (known == different.end()) {
        different.push_back(std::move(failure));
      } else {
        known->count += failure.count;
      }
    }
    return different;
  }

  const ExploreOptions& options_;
  const WorkerPoolOptions& pool_;
  const Clock::time_point began_at_ = Clock::now();
  SharedProgress progress_;   // outlives the processes
  std::deque<Share> shares_;  // they stay where they are
  HashSet traces_{Explorer::distinct_schedules_max};
  ExploreReport explored_;
  std::vector<WorkerGaveUp> errors_;
  std::vector<std::uint64_t> abandoned_;
  std::optional<Clock::time_point> stop_asked_at_;
};

}  // namespace

WorkerPoolReport explore_in_workers(const Scenario& scenario, const StrategyFactory& make_strategy,
                                    const ExploreOptions& options, const WorkerPoolOptions& pool) {
  LTSIM_CHECK(pool.jobs >= 1 && pool.jobs <= WorkerPoolOptions::jobs_max);
  return WorkerPool{scenario, make_strategy, options, pool}.run();
}

}  // namespace ltsim
