#include "tests/scenarios/exchange_monitor.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace scenarios {
namespace {

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes)
    text += fmt::format("{}{:02x}", text.empty() ? "" : " ", std::to_integer<unsigned>(byte));
  return text.empty() ? "nothing" : text;
}

}  // namespace

ExchangeMonitor::ExchangeMonitor(ltsim::World& world, std::string slave_task, Repeatable repeatable)
    : world_(world), slave_task_(std::move(slave_task)), repeatable_(repeatable) {
  constexpr std::size_t usual_requests = 4;
  exchanges_.reserve(usual_requests);
  world_.whenever_idle([this] { check_when_idle(); });
}

void ExchangeMonitor::submitted(std::span<const std::byte> request) noexcept {
  exchanges_.push_back(Exchange{.request = Bytes(request.begin(), request.end()), .answer = {}});
  world_.note([&] { return fmt::format("SUBMIT {}: {}", number_of_current(), hex(request)); });
}

void ExchangeMonitor::published() noexcept {
  doorbell_unanswered_ = true;
  world_.note([&] { return fmt::format("PUBLISH {}", number_of_current()); });
}

void ExchangeMonitor::taken() noexcept {
  doorbell_unanswered_ = false;
  world_.note([] { return "TAKE"; });
}

void ExchangeMonitor::executed(std::span<const std::byte> request) noexcept {
  world_.note([&] { return fmt::format("EXEC {}", hex(request)); });
  const auto found = std::find_if(exchanges_.begin(), exchanges_.end(), [&](const Exchange& exchange) {
    return std::equal(request.begin(), request.end(), exchange.request.begin(), exchange.request.end());
  });
  if (found == exchanges_.end())
    return violated(fmt::format("I3: {} was executed, which nobody submitted", hex(request)));
  executing_ = static_cast<std::size_t>(found - exchanges_.begin());
  if (++found->executed_count > 1 && repeatable_ == Repeatable::no) {
    violated(fmt::format("I5: request {} was executed twice", executing_ + 1));
  }
}

void ExchangeMonitor::answered(std::span<const std::byte> response) noexcept {
  world_.note([&] { return fmt::format("ANSWER {}", hex(response)); });
  if (executing_ != none) exchanges_[executing_].answer.assign(response.begin(), response.end());
}

void ExchangeMonitor::delivered(std::span<const std::byte> response) noexcept {
  world_.note([&] { return fmt::format("DELIVER {}", hex(response)); });
  const auto found = std::find_if(exchanges_.begin(), exchanges_.end(), [&](const Exchange& exchange) {
    return exchange.executed_count != 0 &&
           std::equal(response.begin(), response.end(), exchange.answer.begin(), exchange.answer.end());
  });
  if (found == exchanges_.end()) {
    // Bytes of another request's answer break I1 as well, though they are not the whole of it.
    return violated(fmt::format("{}: {} was delivered for request {}, which nobody answered so",
                                holds_bytes_of_another_answer(response) ? "I1, I4" : "I4", hex(response),
                                number_of_current()));
  }
  const auto from = found - exchanges_.begin() + 1;
  if (&*found != &current()) {
    return violated(
        fmt::format("I1: the answer to request {} was delivered for request {}", from, number_of_current()));
  }
  if (++found->delivered_count > 1)
    violated(fmt::format("I2: the answer to request {} was delivered twice", from));
}

void ExchangeMonitor::ended(protocol::ExchangeOutcome outcome) noexcept {
  world_.note([&] {
    return fmt::format("OUTCOME {}: {}", number_of_current(),
                       outcome == protocol::ExchangeOutcome::ok ? "ok" : "not ok");
  });
  if (++current().ended_count > 1) violated(fmt::format("I18: request {} ended twice", number_of_current()));
}

void ExchangeMonitor::check_at_end() {
  for (std::size_t i = 0; i < exchanges_.size(); ++i) {
    if (exchanges_[i].ended_count != 1)
      world_.require(false, fmt::format("I18: request {} never ended", i + 1));
  }
}

bool ExchangeMonitor::holds_bytes_of_another_answer(std::span<const std::byte> response) const noexcept {
  const auto stands_at = [](const Exchange& exchange, std::size_t place, std::byte byte) {
    return place < exchange.answer.size() && exchange.answer[place] == byte;
  };
  for (std::size_t i = 0; i < response.size(); ++i) {
    if (stands_at(exchanges_.back(), i, response[i])) continue;
    for (const Exchange& other : exchanges_) {
      if (stands_at(other, i, response[i])) return true;
    }
  }
  return false;
}

void ExchangeMonitor::check_when_idle() {
  if (doorbell_unanswered_ && world_.blocked_in(slave_task_).starts_with("sem_wait ")) {
    violated(fmt::format("I9: request {} is published and posted, and {} sleeps", number_of_current(),
                         slave_task_));
  }
}

void ExchangeMonitor::violated(std::string message) {
  const ltsim::GhostScope ghost;
  world_.violated(std::move(message));
}

}  // namespace scenarios
