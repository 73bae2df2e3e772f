#include "tests/scenarios/hardened/hardened_monitor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace scenarios {
namespace {

using Ghost = HardenedWordGhost;
using Outcome = protocol::ExchangeOutcome;
using Use = AreaOwnership::Use;

const ltsim::Task& running() noexcept { return *ltsim::current_task; }

}  // namespace

HardenedMonitor::HardenedMonitor(ltsim::World& world, std::string_view master_process, std::string_view only,
                                 std::uint32_t word, const protocol::hardened::Options& options)
    : world_(world),
      verdict_(world, only),
      master_(world.process(master_process)),
      word_(word),
      ownership_(world),
      queries_max_(options.queries_max),
      take_timeout_(options.take_timeout),
      answer_timeout_(options.answer_timeout),
      losses_granted_(losses_left()) {
  constexpr std::size_t usual_requests = 8;
  exchanges_.reserve(usual_requests);
  world_.whenever_idle([this] { check_when_idle(); });
  world_.whenever_held_up([this](ltsim::SimTime duration) {
    forget_the_killed();
    if (is_under_way()) held_up_ += duration;
  });
}

void HardenedMonitor::submitted(std::span<const std::byte> request) noexcept {
  forget_the_killed();
  exchanges_.push_back({.request = Bytes(request.begin(), request.end()),
                        .answer = {},
                        .task = running().id,
                        .has_time_to_spare = std::exchange(has_time_to_spare_, false),
                        .crashes_before = slave_crashes()});
  submitted_at_ = attempt_began_at_ = now();
  held_up_ = ltsim::SimTime{0};
  losses_left_ = losses_left();
  world_.note([&] { return fmt::format("SUBMIT {}: {}", exchanges_.size(), hex(request)); });
}

void HardenedMonitor::filling() noexcept {
  check_role("writes the request");
  // A slave that stops while the area is filled does not touch it, and the publication fails.
  check_owner({Ghost::idle, Ghost::down}, "writes the request");
  uses(Use::writes_request);
}

void HardenedMonitor::published() noexcept {
  world_.note([&] { return fmt::format("PUBLISH {}", exchanges_.size()); });
  ownership_.leaves(running().id);
}

void HardenedMonitor::taken() noexcept {
  world_.note([] { return "TAKE"; });
  check_role("reads the request");
  check_owner({Ghost::busy, Ghost::orphan}, "reads the request");
  uses(Use::reads_request);
}

void HardenedMonitor::executed(std::span<const std::byte> request) noexcept {
  world_.note([&] { return fmt::format("EXEC {}", hex(request)); });
  check_owner({Ghost::busy, Ghost::orphan}, "writes the response");
  uses(Use::writes_response);
  const auto found = std::ranges::find_if(
      exchanges_, [&](const Exchange& exchange) { return std::ranges::equal(request, exchange.request); });
  if (found == exchanges_.end()) {
    executing_ = none;
    return violated({"I3"},
                    [&] { return fmt::format("{} was executed, which nobody submitted", hex(request)); });
  }
  executing_ = static_cast<std::size_t>(found - exchanges_.begin());
  const std::size_t number = executing_ + 1;
  ++found->executed_count;
  if (found->was_told_not_executed) {
    violated({"I6", "I18"}, [&] {
      return fmt::format("the kernel was told that request {} is not executed, and it was", number);
    });
  }
  if (found->executed_count > 1)
    violated({"I5"}, [&] { return fmt::format("request {} was executed twice", number); });
}

void HardenedMonitor::answered(std::span<const std::byte> response) noexcept {
  world_.note([&] { return fmt::format("ANSWER {}", hex(response)); });
  check_role("writes the response");
  check_owner({Ghost::busy, Ghost::orphan}, "writes the response");
  ownership_.leaves(running().id);
  if (executing_ != none) exchanges_[executing_].answer.assign(response.begin(), response.end());
  executing_ = none;
}

void HardenedMonitor::accepted() noexcept {
  check_role("reads the response");
  check_owner({Ghost::response}, "reads the response");
  uses(Use::reads_response);
}

void HardenedMonitor::delivered(std::span<const std::byte> response) noexcept {
  world_.note([&] { return fmt::format("DELIVER {}", hex(response)); });
  Exchange& own = exchanges_.back();
  const std::size_t number = exchanges_.size();
  const auto found = std::ranges::find_if(exchanges_, [&](const Exchange& exchange) {
    return exchange.executed_count != 0 && std::ranges::equal(response, exchange.answer);
  });
  if (found == exchanges_.end()) {
    return violated({"I4"}, [&] {
      return fmt::format("{} was delivered for request {}, which nobody answered so", hex(response), number);
    });
  }
  ++found->delivered_count;
  const auto from = static_cast<std::size_t>(found - exchanges_.begin()) + 1;
  if (&*found != &own) {
    return violated({"I1"}, [&] {
      return fmt::format("the answer to request {} was delivered for request {}", from, number);
    });
  }
  if (found->delivered_count > 1)
    violated({"I2"}, [&] { return fmt::format("the answer to request {} was delivered twice", from); });
}

void HardenedMonitor::ended(Outcome outcome) noexcept {
  Exchange& own = exchanges_.back();
  world_.note([&] { return fmt::format("OUTCOME {}: {}", exchanges_.size(), to_string(outcome)); });
  ownership_.leaves(running().id);
  own.was_told_not_executed = outcome == Outcome::not_executed;
  if (++own.ended_count > 1)
    violated({"I18"}, [&] { return fmt::format("request {} ended twice", exchanges_.size()); });
  check_ended(own, outcome);
  forget_what_the_end_needed(own);
}

bool HardenedMonitor::is_under_way() const noexcept {
  return !exchanges_.empty() && exchanges_.back().ended_count == 0 && is_alive(exchanges_.back().task);
}

void HardenedMonitor::forget_what_the_end_needed(Exchange& exchange) noexcept {
  exchange.has_time_to_spare = exchange.was_given_up = exchange.slave_has_changed = false;
  exchange.crashes_before = 0;
  submitted_at_ = attempt_began_at_ = held_up_ = ltsim::SimTime{0};
}

void HardenedMonitor::forget_the_killed() noexcept {
  ownership_.forget_killed();
  for (Holder* const holder : {&master_holder_, &slave_holder_}) {
    if (!is_alive(holder->task)) *holder = {};
  }
  if (!is_alive(slave_task_)) executing_ = none;
  if (exchanges_.empty() || is_alive(exchanges_.back().task)) return;
  Exchange& last = exchanges_.back();
  forget_what_the_end_needed(last);
  // It is not delivered any more, and does not end again; only what it was told counts.
  last.delivered_count = 0;
  last.ended_count = 0;
}

void HardenedMonitor::check_ended(const Exchange& exchange, Outcome outcome) {
  const std::size_t number = exchanges_.size();
  const bool slave_has_changed = exchange.slave_has_changed || slave_crashes() != exchange.crashes_before;
  if (outcome == Outcome::not_executed && exchange.executed_count != 0) {
    violated({"I6", "I18"}, [&] {
      return fmt::format("the kernel is told that request {} is not executed, and it was", number);
    });
  }
  if (outcome == Outcome::ok && exchange.delivered_count == 0)
    violated({"I18"}, [&] { return fmt::format("request {} ended ok without an answer", number); });
  if (outcome == Outcome::unknown && !exchange.was_given_up && !slave_has_changed) {
    violated({"I18"}, [&] {
      return fmt::format("request {} ended unknown, and neither was it given up nor the slave killed",
                         number);
    });
  }
  if (outcome == Outcome::rejected)
    violated({"I18"},
             [&] { return fmt::format("request {} was rejected, and nothing is wrong with it", number); });
  const ltsim::SimTime took = now() - submitted_at_;
  const ltsim::SimTime for_an_attempt = take_timeout_ + answer_timeout_;
  if (took > for_an_attempt * (1 + queries_max_) + held_up_ + time_to_react) {
    violated({"I15"}, [&] {
      return fmt::format("request {} took {} ns, of which {} were held up", number, took.count(),
                         held_up_.count());
    });
  }
  const bool had_its_time = held_up_ + time_to_see < std::min(take_timeout_, answer_timeout_);
  const bool is_excused = slave_has_changed || a_ring_was_lost();
  if (exchange.has_time_to_spare && had_its_time && !is_excused && outcome != Outcome::ok) {
    violated({"I17"}, [&] {
      return fmt::format("request {} had time to spare, and ended {}", number, to_string(outcome));
    });
  }
}

void HardenedMonitor::attached() noexcept {
  forget_the_killed();
  const bool is_of_master = is_master();
  world_.note([&] { return fmt::format("ATTACH {}", is_of_master ? "master" : "slave"); });
  Holder& holder = own_role();
  if (holder.holds && holder.task != running().id && is_alive(holder.task)) {
    violated({"I28"}, [&] {
      return fmt::format("{} attaches to a role that {} plays", running().name,
                         world_.scheduler().task(holder.task).name);
    });
  }
  holder = {.task = running().id, .holds = true};
  if (is_of_master) return;
  slave_ = &world_.process(running().process);
  slave_task_ = running().id;
  executing_ = none;
  if (is_under_way()) exchanges_.back().slave_has_changed = true;
}

void HardenedMonitor::detaching() noexcept {
  const bool is_of_master = is_master();
  world_.note([&] { return fmt::format("DETACH {}", is_of_master ? "master" : "slave"); });
  own_role().holds = false;
}

void HardenedMonitor::moved(std::uint32_t from, std::uint32_t to) noexcept {
  using Mover = Ghost::Mover;
  const auto wrong = word_.moves(is_master() ? Mover::master : Mover::slave, from, to);
  if (wrong) violated({"I14"}, [&] { return *wrong; });
  // The swap that the running task has just made; between it and this event lies no other step.
  if (world_.segments().value_at(world_.scheduler().pending(running())) != to)
    violated({"I14"}, [] { return std::string{"the state word is not what it was made"}; });
  if (Ghost::generation_of(from) != Ghost::generation_of(to)) return;  // an attach
  check_role("moves the state word");
  if (exchanges_.empty()) return;
  Exchange& last = exchanges_.back();
  if (!is_master()) {
    if (Ghost::phase_of(to) == Ghost::down) last.slave_has_changed = true;
    return;
  }
  if (Ghost::phase_of(from) == Ghost::request) {
    check_early(take_timeout_, "was withdrawn");
    attempt_began_at_ = now();
  }
  if (Ghost::phase_of(from) == Ghost::busy) {
    check_early(take_timeout_ + answer_timeout_, "was given up");
    attempt_began_at_ = now();
    last.was_given_up = true;
  }
}

void HardenedMonitor::check_at_end() {
  if (world_.failed()) return;
  for (std::size_t i = 0; i < exchanges_.size(); ++i) {
    if (exchanges_[i].ended_count != 1 && is_alive(exchanges_[i].task))
      violated({"I18"}, [&] { return fmt::format("request {} never ended", i + 1); });
  }
}

void HardenedMonitor::check_when_idle() {
  forget_the_killed();
  const auto sleeps = [this](ltsim::TaskId task, ltsim::OperationKind kind) {
    const ltsim::Task& sleeper = world_.scheduler().task(task);
    return sleeper.state == ltsim::Task::State::blocked && world_.scheduler().pending(sleeper).kind == kind;
  };
  if (exchanges_.empty() || a_ring_was_lost() || slave_ == nullptr || !is_alive(slave_task_)) return;
  const ltsim::TaskId sender = exchanges_.back().task;
  // Who was killed between a move and the ring that follows has not rung; the next one who attaches sees to that.
  if (!is_alive(sender)) return;
  if (word_.phase() == Ghost::request && sleeps(slave_task_, ltsim::OperationKind::sem_wait)) {
    violated({"I9"}, [&] {
      return fmt::format("request {} is published, and {} sleeps", exchanges_.size(),
                         world_.scheduler().task(slave_task_).name);
    });
  }
  if (word_.phase() == Ghost::response && sleeps(sender, ltsim::OperationKind::sem_timedwait)) {
    violated({"I9"}, [&] {
      return fmt::format("request {} is answered, and {} sleeps", exchanges_.size(),
                         world_.scheduler().task(sender).name);
    });
  }
}

void HardenedMonitor::check_role(std::string_view what) {
  const Holder& holder = own_role();
  if (holder.holds && holder.task == running().id) return;
  violated({"I12"}, [&] { return fmt::format("{} {}, and does not hold its role", running().name, what); });
}

void HardenedMonitor::check_early(ltsim::SimTime full, std::string_view what) {
  const ltsim::SimTime passed = now() - attempt_began_at_;
  if (passed >= full) return;
  violated({"I16"}, [&] {
    return fmt::format("request {} {} after {} ns, and its time is {} ns", exchanges_.size(), what,
                       passed.count(), full.count());
  });
}

std::uint32_t HardenedMonitor::losses_left() const noexcept {
  return world_.faults().times_left(ltsim::FaultKind::lost_post);
}

bool HardenedMonitor::a_ring_was_lost() const noexcept {
  const bool is_weak = world_.memory() != ltsim::Memory::sc;
  return losses_left() != (is_weak ? losses_granted_ : losses_left_);
}

ltsim::SimTime HardenedMonitor::now() const noexcept { return world_.now(); }

void HardenedMonitor::check_owner(std::initializer_list<Phase> phases, std::string_view use) {
  if (std::ranges::find(phases, word_.phase()) != phases.end()) return;
  violated({"I7"}, [&] { return fmt::format("{} {}, and is not its owner", running().name, use); });
}

void HardenedMonitor::uses(Use use) {
  ownership_.enters(running().id, use);
  if (ownership_.first_conflict()) violated({"I7"}, [&] { return *ownership_.first_conflict(); });
}

bool HardenedMonitor::is_master() const { return running().process == master_.id(); }

bool HardenedMonitor::is_alive(ltsim::TaskId task) const {
  return world_.scheduler().task(task).state != ltsim::Task::State::killed;
}

unsigned HardenedMonitor::slave_crashes() const { return slave_ == nullptr ? 0 : slave_->crashes(); }

}  // namespace scenarios
