// Makes a few choices at decisions addressed by number, and the default everywhere else: an execution without
// listener and without names, for searches that run very many of them.
//
// A decision's address is whose turn it is, what is asked and for the how-many-eth time. It holds within one
// build and as long as the choices before it are the same; for the time in between there are the anchors of a
// schedule.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim_clock/explore/causal_hash.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

enum class Question : std::uint8_t { task, slow_moment, fault, answer, age };
inline constexpr std::size_t questions_count = 5;

struct DecisionAddress {
  Question question = Question::task;
  std::uint16_t whose = 0;    ///< task, slow_moment, age: the running task; fault: its kind; answer: 0
  std::uint32_t ordinal = 0;  ///< from 0

  bool operator==(const DecisionAddress&) const = default;
};

struct AddressedDeviation {
  DecisionAddress at{};
  std::uint32_t value =
      0;  ///< task: the number of the one chosen; fault: its variant; answer; age: so many are newer
  SlowMoment slow{};  ///< slow_moment
};

/// Which deviations a search tries.
struct SearchFilter {
  std::array<bool, questions_count> questions{true, true, true, true, true};  ///< by Question
  std::uint64_t tasks =
      ~std::uint64_t{0};      ///< bit = number of a task that may be switched from and to; 63: all further
  bool whole_machine = true;  ///< slow moments of everybody
  bool single_tasks = true;   ///< slow moments of one task
  bool until_next_timer = true;
  std::vector<SimTime> durations;
};

/// Counts the decisions of an execution.
class DecisionCounter {
 public:
  void reset() noexcept;
  [[nodiscard]] DecisionAddress next(Question question, std::size_t whose) noexcept;

 private:
  static constexpr std::size_t tasks_max = 256;
  std::array<std::array<std::uint32_t, tasks_max>, questions_count> counts_{};
};

class AddressedStrategy final : public Strategy {
 public:
  /// @param deviations  in any order; those whose decision never comes are passed over
  void set_deviations(const std::vector<AddressedDeviation>& deviations) { deviations_ = deviations; }
  /// From the next execution on, all deviations that could follow the last one taken are listed; null: none.
  /// @param anywhere  also those that could have come before it
  void list_alternatives(const SearchFilter* filter, bool anywhere) noexcept {
    filter_ = filter;
    anywhere_ = anywhere;
  }
  /// Of the last execution, in order of time.
  [[nodiscard]] const std::vector<AddressedDeviation>& alternatives() const noexcept { return alternatives_; }
  /// Equal for executions in which the same things happened in the same causal order.
  [[nodiscard]] std::uint64_t causal_hash() const noexcept { return causes_.value(); }

  [[nodiscard]] std::string_view name() const noexcept override { return "addressed"; }
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;
  [[nodiscard]] bool follows_steps() const noexcept override { return true; }
  void performs(TaskId task, const Operation& operation) noexcept override { causes_.add(task, operation); }

 private:
  [[nodiscard]] const AddressedDeviation* find(const DecisionAddress& address) noexcept;
  [[nodiscard]] bool lists(Question question) const noexcept {
    return filter_ != nullptr && filter_->questions[static_cast<std::size_t>(question)] &&
           (anywhere_ || taken_count_ == deviations_.size()) && alternatives_.size() < alternatives_max;
  }
  /// `count` numbers from 1 to `maximum`, evenly spread.
  void list_numbers(const DecisionAddress& address, std::size_t maximum);

  static constexpr std::size_t alternatives_max = std::size_t{1} << 18U;

  std::vector<AddressedDeviation> deviations_;
  std::size_t taken_count_ = 0;
  DecisionCounter counter_;
  CausalHash causes_;
  const SearchFilter* filter_ = nullptr;
  bool anywhere_ = false;
  std::vector<AddressedDeviation> alternatives_;
};

/// Passes on what another strategy chooses, and keeps its deviations by address.
class AddressRecorder final : public Strategy {
 public:
  explicit AddressRecorder(Strategy& chooser) noexcept : chooser_(chooser) {}

  [[nodiscard]] const std::vector<AddressedDeviation>& deviations() const noexcept { return deviations_; }

  [[nodiscard]] std::string_view name() const noexcept override { return chooser_.name(); }
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;

 private:
  Strategy& chooser_;
  DecisionCounter counter_;
  std::vector<AddressedDeviation> deviations_;
};

}  // namespace ltsim
