#include "sim_clock/explore/addressed_strategy.hpp"

#include <algorithm>

namespace ltsim {
namespace {

bool allows(const SearchFilter& filter, std::uint64_t task) noexcept {
  return (filter.tasks >> std::min<std::uint64_t>(task, 63) & 1U) != 0;
}

}  // namespace

void DecisionCounter::reset() noexcept {
  for (auto& counts : counts_) counts.fill(0);
}

DecisionAddress DecisionCounter::next(Question question, std::size_t whose) noexcept {
  return {.question = question,
          .whose = static_cast<std::uint16_t>(whose),
          .ordinal = counts_[static_cast<std::size_t>(question)][whose]++};
}

void AddressedStrategy::begin_execution(std::uint64_t /*seed*/) noexcept {
  counter_.reset();
  causes_.reset();
  taken_count_ = 0;
  alternatives_.clear();
}

std::size_t AddressedStrategy::choose_task(const TaskChoice& choice) noexcept {
  const DecisionAddress address = counter_.next(Question::task, choice.running);
  if (const AddressedDeviation* const deviation = find(address)) {
    const auto option = std::find(choice.options.begin(), choice.options.end(), deviation->value);
    return option == choice.options.end() ? 0 : static_cast<std::size_t>(option - choice.options.begin());
  }
  if (lists(Question::task) && allows(*filter_, choice.running)) {
    for (const std::uint64_t option : choice.options.subspan(1)) {
      if (allows(*filter_, option))
        alternatives_.push_back({.at = address, .value = static_cast<std::uint32_t>(option), .slow = {}});
    }
  }
  return 0;
}

SlowMoment AddressedStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  const DecisionAddress address = counter_.next(Question::slow_moment, choice.running);
  if (const AddressedDeviation* const deviation = find(address)) return deviation->slow;
  if (lists(Question::slow_moment) && allows(*filter_, choice.running)) {
    const auto list = [&](SimTime duration) {
      if (filter_->whole_machine) alternatives_.push_back({.at = address, .slow = {.duration = duration}});
      if (filter_->single_tasks && choice.running_can_be_held_up)
        alternatives_.push_back({.at = address, .slow = {.duration = duration, .others_go_on = true}});
    };
    if (filter_->until_next_timer && choice.until_next_timer != VirtualClock::never &&
        choice.until_next_timer > SimTime{0})
      list(choice.until_next_timer);
    for (const SimTime duration : filter_->durations) list(duration);
  }
  return {};
}

std::size_t AddressedStrategy::strike(FaultKind kind, std::size_t variants_count) noexcept {
  const DecisionAddress address = counter_.next(Question::fault, static_cast<std::size_t>(kind));
  if (const AddressedDeviation* const deviation = find(address))
    return deviation->value <= variants_count ? deviation->value : 0;
  if (lists(Question::fault)) list_numbers(address, variants_count);
  return 0;
}

std::size_t AddressedStrategy::answer(std::size_t count) noexcept {
  const DecisionAddress address = counter_.next(Question::answer, 0);
  if (const AddressedDeviation* const deviation = find(address))
    return deviation->value < count ? deviation->value : 0;
  if (lists(Question::answer)) list_numbers(address, count - 1);
  return 0;
}

std::size_t AddressedStrategy::choose_age(const AgeChoice& choice) noexcept {
  const DecisionAddress address = counter_.next(Question::age, choice.running);
  if (const AddressedDeviation* const deviation = find(address)) {
    const auto age = std::find(choice.ages.begin(), choice.ages.end(), deviation->value);
    if (age == choice.ages.end()) return 0;
    causes_.add_age(choice.running, *age);
    return static_cast<std::size_t>(age - choice.ages.begin());
  }
  if (lists(Question::age) && allows(*filter_, choice.running)) {
    for (const std::uint32_t age : choice.ages.subspan(1))
      alternatives_.push_back({.at = address, .value = age, .slow = {}});
  }
  return 0;
}

const AddressedDeviation* AddressedStrategy::find(const DecisionAddress& address) noexcept {
  if (taken_count_ == deviations_.size()) return nullptr;
  for (const AddressedDeviation& deviation : deviations_) {
    if (deviation.at != address) continue;
    ++taken_count_;
    return &deviation;
  }
  return nullptr;
}

void AddressedStrategy::list_numbers(const DecisionAddress& address, std::size_t maximum) {
  constexpr std::size_t listed_max = 16;
  const std::size_t listed = std::min(maximum, listed_max);
  for (std::size_t i = 0; i < listed; ++i) {
    const std::size_t number = 1 + i * maximum / listed;
    alternatives_.push_back({.at = address, .value = static_cast<std::uint32_t>(number), .slow = {}});
  }
}

void AddressRecorder::begin_execution(std::uint64_t seed) noexcept {
  counter_.reset();
  deviations_.clear();
  chooser_.begin_execution(seed);
}

std::size_t AddressRecorder::choose_task(const TaskChoice& choice) noexcept {
  const DecisionAddress address = counter_.next(Question::task, choice.running);
  const std::size_t chosen = chooser_.choose_task(choice);
  if (chosen != 0)
    deviations_.push_back(
        {.at = address, .value = static_cast<std::uint32_t>(choice.options[chosen]), .slow = {}});
  return chosen;
}

SlowMoment AddressRecorder::slow_moment(const SlowMomentChoice& choice) noexcept {
  const DecisionAddress address = counter_.next(Question::slow_moment, choice.running);
  const SlowMoment moment = chooser_.slow_moment(choice);
  if (moment.duration != SimTime{0}) deviations_.push_back({.at = address, .slow = moment});
  return moment;
}

std::size_t AddressRecorder::strike(FaultKind kind, std::size_t variants_count) noexcept {
  const DecisionAddress address = counter_.next(Question::fault, static_cast<std::size_t>(kind));
  const std::size_t variant = chooser_.strike(kind, variants_count);
  if (variant != 0)
    deviations_.push_back({.at = address, .value = static_cast<std::uint32_t>(variant), .slow = {}});
  return variant;
}

std::size_t AddressRecorder::answer(std::size_t count) noexcept {
  const DecisionAddress address = counter_.next(Question::answer, 0);
  const std::size_t answered = chooser_.answer(count);
  if (answered != 0)
    deviations_.push_back({.at = address, .value = static_cast<std::uint32_t>(answered), .slow = {}});
  return answered;
}

std::size_t AddressRecorder::choose_age(const AgeChoice& choice) noexcept {
  const DecisionAddress address = counter_.next(Question::age, choice.running);
  const std::size_t chosen = chooser_.choose_age(choice);
  if (chosen != 0) deviations_.push_back({.at = address, .value = choice.ages[chosen], .slow = {}});
  return chosen;
}

}  // namespace ltsim
