#include "tests/scenarios/exchange_monitor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace scenarios {
namespace {

using Use = AreaOwnership::Use;

}  // namespace

ExchangeMonitor::ExchangeMonitor(ltsim::World& world, const protocol::PaperOptions& paper,
                                 const Options& options)
    : world_(world),
      verdict_(world, options.only),
      paper_(paper),
      options_(options),
      ownership_(world),
      state_word_(paper.state_coding) {
  constexpr std::size_t usual_requests = 4;
  exchanges_.reserve(usual_requests);
  world_.whenever_idle([this] { check_when_idle(); });
}

void ExchangeMonitor::slave_opened() {
  using Initialiser = protocol::PaperOptions::Initialiser;
  const bool has_zeroed =
      paper_.initialiser == Initialiser::slave || paper_.initialiser == Initialiser::creator_and_slave;
  if (has_zeroed && published_count_ != 0) reset_in_use_ = true;
}

void ExchangeMonitor::submitted(std::span<const std::byte> request) noexcept {
  exchanges_.push_back(Exchange{.request = Bytes(request.begin(), request.end()),
                                .answer = {},
                                .task = running().id,
                                .tasks_count = world_.scheduler().tasks_count()});
  ownership_.enters(running().id, Use::writes_request);
  world_.note([&] { return fmt::format("SUBMIT {}: {}", exchanges_.size(), hex(request)); });
  tell_state(MasterStep::submitted);
}

void ExchangeMonitor::published() noexcept {
  const std::size_t own = index_of_own();
  world_.note([&] { return fmt::format("PUBLISH {}", own + 1); });
  ownership_.leaves(running().id);
  ++published_count_;
  exchanges_[own].published = true;
  exchanges_[own].taken = false;
  exchanges_[own].sender_waits = true;
  tell_state(MasterStep::waits);
  state_word_.publish_request();
  check_state_word();
}

void ExchangeMonitor::taken() noexcept {
  world_.note([] { return "TAKE"; });
  ownership_.enters(running().id, Use::reads_request);
  ++taken_count_;
  for (Exchange& exchange : exchanges_) exchange.taken = exchange.published;
  tell_state(SlaveStep::taken);
  if (served_ && serving_ != running().process) {
    violated({"I28"}, [&] {
      return fmt::format("{} and {} serve the same kernel", world_.process_name(serving_),
                         world_.process_name(running().process));
    });
  }
  serving_ = running().process;
  served_ = true;
}

void ExchangeMonitor::executed(std::span<const std::byte> request) noexcept {
  world_.note([&] { return fmt::format("EXEC {}", hex(request)); });
  ownership_.enters(running().id, Use::writes_response);
  const std::string_view token_only = taken_count_ > published_count_ ? "I11" : "";
  const auto found = std::ranges::find_if(
      exchanges_, [&](const Exchange& exchange) { return std::ranges::equal(request, exchange.request); });
  executing_ = found == exchanges_.end() ? none : static_cast<std::size_t>(found - exchanges_.begin());
  tell_state(SlaveStep::executes);
  if (found == exchanges_.end()) {
    return violated({"I3", token_only, reset_in_use_ ? "I29" : ""},
                    [&] { return fmt::format("{} was executed, which nobody submitted", hex(request)); });
  }
  const std::size_t number = executing_ + 1;
  ++found->executed_count;
  if (found->not_executed) {
    violated({"I6", "I18"}, [&] {
      return fmt::format("the kernel was told that request {} is not executed, and it was", number);
    });
  }
  if (found->executed_count > 1 && options_.repeatable == Repeatable::no)
    violated({"I5", token_only}, [&] { return fmt::format("request {} was executed twice", number); });
}

void ExchangeMonitor::answered(std::span<const std::byte> response) noexcept {
  world_.note([&] { return fmt::format("ANSWER {}", hex(response)); });
  ownership_.leaves(running().id);
  if (executing_ == none) {
    invented_answers_.emplace_back(response.begin(), response.end());
  } else {
    exchanges_[executing_].answer.assign(response.begin(), response.end());
  }
  tell_state(SlaveStep::answers);
}

void ExchangeMonitor::announced() noexcept {
  unread_ = executing_;
  tell_state(SlaveStep::waits);
  state_word_.publish_response();
  check_state_word();
}

void ExchangeMonitor::accepted() noexcept {
  ownership_.enters(running().id, Use::reads_response);
  unread_ = none;
  tell_state(MasterStep::reads);
}

void ExchangeMonitor::delivered(std::span<const std::byte> response) noexcept {
  world_.note([&] { return fmt::format("DELIVER {}", hex(response)); });
  const bool takes_back = paper_.read_wait == protocol::PaperOptions::ReadWait::poll &&
                          paper_.state_taken_back == protocol::PaperOptions::StateTakenBack::by_master;
  if (takes_back) {
    state_word_.take_back_response();
    check_state_word();
  }
  const bool wiped_another = takes_back && unread_ != none && exchanges_[unread_].delivered_count == 0;
  check_delivered(response, wiped_another);
  ownership_.leaves(running().id);
}

void ExchangeMonitor::check_delivered(std::span<const std::byte> response, bool wiped_another) {
  Exchange& own = exchanges_[index_of_own()];
  const std::size_t number = index_of_own() + 1;
  own.sender_waits = false;
  const auto found = std::ranges::find_if(exchanges_, [&](const Exchange& exchange) {
    return exchange.executed_count != 0 && std::ranges::equal(response, exchange.answer);
  });
  const bool is_invented = std::ranges::any_of(
      invented_answers_, [&](const Bytes& answer) { return std::ranges::equal(response, answer); });
  if (found == exchanges_.end() && is_invented) return;  // the harm was done when that was executed: I3
  if (found == exchanges_.end() && response.empty()) {
    return violated({"I1"}, [&] {
      return fmt::format("nothing was delivered for request {}, which nobody answered yet", number);
    });
  }
  if (found == exchanges_.end()) {
    return violated({"I4", ownership_.is_disturbed(running().id) ? "I7" : ""}, [&] {
      return fmt::format("{} was delivered for request {}, which nobody answered so", hex(response), number);
    });
  }
  ++found->delivered_count;
  const bool foreign = &*found != &own;
  if (foreign && options_.foreign_answers_tolerated != 0) {
    --options_.foreign_answers_tolerated;
    return;
  }
  const auto from = static_cast<std::size_t>(found - exchanges_.begin()) + 1;
  if (wiped_another && unread_ + 1 != from) {
    violated({foreign ? "I1" : "", "I18"}, [&] {
      return fmt::format("the answer to request {} was wiped unread, when that to {} was delivered for {}",
                         unread_ + 1, from, number);
    });
  }
  if (foreign) {
    return violated({"I1"}, [&] {
      return fmt::format("the answer to request {} was delivered for request {}", from, number);
    });
  }
  if (found->delivered_count > 1)
    violated({"I2"}, [&] { return fmt::format("the answer to request {} was delivered twice", from); });
}

void ExchangeMonitor::ended(protocol::ExchangeOutcome outcome) noexcept {
  // The wrapper means the request that it was given last, whichever thread gave it.
  Exchange& last = exchanges_.back();
  world_.note([&] { return fmt::format("OUTCOME {}: {}", exchanges_.size(), to_string(outcome)); });
  if (last.task == running().id) last.sender_waits = false;
  tell_state(MasterStep::at_rest);
  last.not_executed = outcome == protocol::ExchangeOutcome::not_executed;
  if (++last.ended_count > 1)
    violated({"I18"}, [&] { return fmt::format("request {} ended twice", exchanges_.size()); });
}

void ExchangeMonitor::check_at_end() {
  if (world_.failed()) return;
  for (std::size_t i = 0; i < exchanges_.size(); ++i) {
    const bool sender_was_killed =
        world_.scheduler().task(exchanges_[i].task).state == ltsim::Task::State::killed;
    if (exchanges_[i].ended_count != 1 && !sender_was_killed)
      violated({"I18"}, [&] { return fmt::format("request {} never ended", i + 1); });
  }
  if (reset_in_use_)
    violated({"I29"}, [] { return std::string{"the segment was filled with zeros while it was in use"}; });
  if (ownership_.first_conflict()) violated({"I7"}, [&] { return *ownership_.first_conflict(); });
}

void ExchangeMonitor::tell_state(MasterStep step) {
  master_step_ = step;
  tell_state();
}

void ExchangeMonitor::tell_state(SlaveStep step) {
  slave_step_ = step;
  tell_state();
}

void ExchangeMonitor::tell_state() {
  if (!world_.coverage().marks()) return;
  constexpr std::size_t digit_max = 15;
  std::uint64_t state = 0;
  const auto add = [&](std::size_t digit) { state = state << 4U | std::min(digit, digit_max); };
  add(static_cast<std::size_t>(master_step_));
  add(static_cast<std::size_t>(slave_step_));
  add(exchanges_.size());
  add(executing_ == none ? digit_max : exchanges_.size() - executing_);  // how far the emulator is behind
  add(unread_ == none ? digit_max : exchanges_.size() - unread_);
  add(published_count_ - std::min(published_count_, taken_count_));
  if (!exchanges_.empty()) {
    const Exchange& last = exchanges_.back();
    add(last.executed_count);
    add(last.delivered_count);
    add((last.sender_waits ? 1U : 0U) + (state_word_.says_response() ? 2U : 0U));
  }
  world_.abstract_state(state);
}

void ExchangeMonitor::check_state_word() {
  // The store that the running task has just made; between it and the event lies no other step.
  const ltsim::Operation& store = world_.scheduler().pending(running());
  if (world_.segments().value_at(store) != state_word_.word())
    violated({"I14"}, [] { return std::string{"a change of the state word has undone another"}; });
}

void ExchangeMonitor::check_when_idle() {
  if (state_word_.says_response()) return;
  const auto waiting = std::ranges::find_if(
      exchanges_, [this](const Exchange& exchange) { return waits_for_answer(exchange); });
  if (waiting == exchanges_.end()) return;
  const ltsim::Task* const slave = sleeping_slave();
  if (slave == nullptr) return;
  const auto number = waiting - exchanges_.begin() + 1;
  if (slave->id >= waiting->tasks_count) {
    violated({"I17", "I18"}, [&] {
      return fmt::format("request {} was taken by an emulator that was killed, and the next one sleeps",
                         number);
    });
  } else if (!waiting->taken) {
    violated({"I9"}, [&] {
      return fmt::format("request {} is published and posted, and {} sleeps", number, slave->name);
    });
  } else {
    violated({"I18"}, [&] {
      return fmt::format("request {} will never be answered: {} sleeps", number, slave->name);
    });
  }
  // A kernel that waits for ever would do so now, and another invariant is judged by.
  if (paper_.on_time_out == protocol::PaperOptions::OnTimeOut::wait_for_ever) world_.finish();
}

bool ExchangeMonitor::waits_for_answer(const Exchange& exchange) const noexcept {
  const ltsim::Task& sender = world_.scheduler().task(exchange.task);
  return exchange.sender_waits && sender.state == ltsim::Task::State::blocked &&
         world_.scheduler().pending(sender).kind == ltsim::OperationKind::sleep;
}

const ltsim::Task* ExchangeMonitor::sleeping_slave() const noexcept {
  for (std::size_t i = 0; i < world_.scheduler().tasks_count(); ++i) {
    const ltsim::Task& task = world_.scheduler().task(static_cast<ltsim::TaskId>(i));
    if (task.state == ltsim::Task::State::blocked &&
        world_.scheduler().pending(task).kind == ltsim::OperationKind::sem_wait) {
      return &task;
    }
  }
  return nullptr;
}

const ltsim::Task& ExchangeMonitor::running() const noexcept { return *ltsim::current_task; }

std::size_t ExchangeMonitor::index_of_own() const noexcept {
  const auto own = std::find_if(exchanges_.rbegin(), exchanges_.rend(),
                                [this](const Exchange& exchange) { return exchange.task == running().id; });
  return own == exchanges_.rend() ? none : static_cast<std::size_t>(exchanges_.rend() - own) - 1;
}

}  // namespace scenarios
