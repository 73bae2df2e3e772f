// A history of operations on one object, recorded by a scenario and checked against a sequential model of it.
//
//     struct Counter {                                      // the model: what the object does, one call at a time
//       using State = int;                                  // ordered by <
//       struct Operation { int added; };
//       using Result = int;
//       static State initial() { return 0; }
//       /// @param result  null: not known, every result is allowed
//       /// @return        the next state; nothing if the object would not answer so
//       static std::optional<State> step(const State& state, const Operation& operation, const Result* result);
//       static std::string operation_text(const Operation& operation);
//       static std::string result_text(const Result& result);
//       // if the object is many independent ones:
//       static int partition(const Operation& operation);   // ordered by <; each part is checked alone
//     };
//
//     History<Counter> history;
//     ... in a task:   const auto call = history.call({.added = 1});
//                      ...
//                      history.returned(call, sum);          // or timed_out(call)
//     world.run();
//     history.check_at_end(world);
//
// Recording is an append: one task runs at a time, and the order of calls and returns is that in which they
// come here, not time. A step with an unknown result must be allowed wherever one with some result is, and
// lead to one state: objects that choose are not covered.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/check/history_text.hpp"
#include "sim_clock/check/linearizability.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {

template <typename Model>
concept SequentialModel =
    std::totally_ordered<typename Model::State> &&
    requires(const typename Model::State& state, const typename Model::Operation& operation,
             const typename Model::Result& result) {
      { Model::initial() } -> std::same_as<typename Model::State>;
      { Model::step(state, operation, &result) } -> std::same_as<std::optional<typename Model::State>>;
      { Model::operation_text(operation) } -> std::convertible_to<std::string>;
      { Model::result_text(result) } -> std::convertible_to<std::string>;
    };

struct HistoryReport {
  Linearizability verdict = Linearizability::linearizable;
  std::uint64_t configurations = 0;  ///< looked at, in all parts
  /// Unless linearizable: why. Of what is not linearizable, the shortest beginning that is not.
  std::string message;
};

template <SequentialModel Model>
class History {
 public:
  using Operation = typename Model::Operation;
  using Result = typename Model::Result;
  using CallNumber = std::size_t;

  /// Some tens of milliseconds.
  static constexpr std::uint64_t configurations_max_default = 100'000;

  /// The operation begins.
  /// @param task  who calls
  CallNumber call(Operation operation, std::string task = running_task_name()) {
    records_.push_back({.operation = std::move(operation),
                        .result = {},
                        .task = std::move(task),
                        .interval = {.called_at = events_count_++},
                        .timed_out = false});
    return records_.size() - 1;
  }
  /// It has ended with this result.
  void returned(CallNumber call, Result result) {
    records_[call].result = std::move(result);
    returned_unseen(call);
  }
  /// It has ended, and taken effect; nobody looked at its result.
  void returned_unseen(CallNumber call) { records_[call].interval.returned_at = events_count_++; }
  /// Its caller gave up: it may have taken effect, or may yet, or never will. To say nothing means the same.
  void timed_out(CallNumber call) { records_[call].timed_out = true; }

  [[nodiscard]] HistoryReport check(std::uint64_t configurations_max = configurations_max_default) const {
    HistoryReport report;
    for (const Part& part : parts()) {
      Judge judge{records_, part, configurations_max};
      const LinearizabilityResult result = judge.check(events_count_);
      report.configurations += result.configurations;
      if (result.verdict == Linearizability::not_linearizable) {
        report.verdict = result.verdict;
        report.message = "history is not linearizable: no order of these operations gives the last result" +
                         text_before(judge.shortest_end(), part);
        return report;
      }
      if (result.verdict == Linearizability::not_decided) {
        report.verdict = result.verdict;
        report.message =
            fmt::format("history is not decided within {} configurations: {} operations overlap too much",
                        configurations_max, part.size());
      }
    }
    return report;
  }

  /// After World::run(): a history that is not linearizable is an invariant that does not hold, one that is
  /// not decided ends the exploration as our limit. After a failure it does nothing.
  void check_at_end(World& world, std::uint64_t configurations_max = configurations_max_default) const {
    if (world.failed()) return;
    HistoryReport report = check(configurations_max);
    if (report.verdict == Linearizability::not_linearizable) world.violated(std::move(report.message));
    if (report.verdict == Linearizability::not_decided) world.unsupported(std::move(report.message));
  }

 private:
  using State = typename Model::State;
  struct Record {
    Operation operation;
    std::optional<Result> result;
    std::string task;
    OperationInterval interval;
    bool timed_out;
  };
  using Part = std::vector<std::size_t>;  // indices of records, in the order of calls

  /// One part of the history, with its states numbered in the order in which they are met.
  class Judge {
   public:
    Judge(const std::vector<Record>& records, const Part& part, std::uint64_t configurations_max)
        : records_(records), part_(part), configurations_max_(configurations_max) {
      for (const std::size_t index : part) intervals_.push_back(records[index].interval);
    }

    LinearizabilityResult check(std::uint32_t events_end) {
      return check_linearizability(
          intervals_, events_end, number_of(Model::initial()),
          [this](StateNumber state, std::size_t operation, bool returned) -> std::optional<StateNumber> {
            const Record& record = records_[part_[operation]];
            const bool known = returned && record.result.has_value();
            const auto next =
                Model::step(*states_[state], record.operation, known ? &*record.result : nullptr);
            return next ? std::optional{number_of(*next)} : std::nullopt;
          },
          configurations_max_);
    }

    /// The least number of events that is not linearizable: what is not stays so, whatever follows.
    std::uint32_t shortest_end() {
      std::vector<std::uint32_t> ends;  // only a return can break a history
      for (const OperationInterval& interval : intervals_) {
        if (interval.returned_at != OperationInterval::never) ends.push_back(interval.returned_at + 1);
      }
      std::sort(ends.begin(), ends.end());
      return *std::partition_point(ends.begin(), ends.end() - 1, [this](std::uint32_t end) {
        return check(end).verdict != Linearizability::not_linearizable;
      });
    }

   private:
    StateNumber number_of(const State& state) {
      const auto [entry, is_new] = numbers_.try_emplace(state, static_cast<StateNumber>(states_.size()));
      if (is_new) states_.push_back(&entry->first);
      return entry->second;
    }

    const std::vector<Record>& records_;
    const Part& part_;
    std::uint64_t configurations_max_;
    std::vector<OperationInterval> intervals_;
    std::map<State, StateNumber> numbers_;
    std::vector<const State*> states_;  // by number
  };

  [[nodiscard]] std::vector<Part> parts() const {
    std::vector<Part> parts;
    if constexpr (requires(const Operation& operation) { Model::partition(operation); }) {
      std::map<decltype(Model::partition(std::declval<const Operation&>())), Part> by_key;
      for (std::size_t i = 0; i < records_.size(); ++i)
        by_key[Model::partition(records_[i].operation)].push_back(i);
      for (auto& [key, part] : by_key) parts.push_back(std::move(part));
    } else {
      parts.emplace_back();
      for (std::size_t i = 0; i < records_.size(); ++i) parts.front().push_back(i);
    }
    return parts;
  }

  [[nodiscard]] std::string text_before(std::uint32_t events_end, const Part& part) const {
    std::vector<HistoryLine> lines;
    for (const std::size_t index : part) {
      const Record& record = records_[index];
      if (record.interval.called_at >= events_end) break;
      HistoryLine line{.task = record.task,
                       .text = Model::operation_text(record.operation),
                       .called_at = record.interval.called_at,
                       .returned_at = record.interval.returned_at};
      if (record.interval.returned_at >= events_end) {
        line.returned_at = OperationInterval::never;
        line.text += record.timed_out ? ", timed out: may have taken effect" : ", not returned yet";
      } else {
        line.text += record.result ? " = " + std::string{Model::result_text(*record.result)}
                                   : std::string{", result not seen"};
      }
      lines.push_back(std::move(line));
    }
    return history_text(lines);
  }

  std::vector<Record> records_;
  std::uint32_t events_count_ = 0;
};

}  // namespace ltsim
