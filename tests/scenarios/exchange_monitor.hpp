// Watches one exchange between a kernel and an emulator, both sides at once, and ends the execution when an
// invariant breaks.
//
// Ghost state: what each request and each answer was, who executed and delivered what. Requests must differ
// from each other and answers too, so that bytes tell to which request they belong. The invariants are
// numbered as in protocol/README.md.
//
//   I1   an answer is delivered for the request it answers
//   I2   a request gets at most one answer, an answer is delivered at most once
//   I3   what is executed is a request that was submitted, whole
//   I4   what is delivered is an answer that was given, whole
//   I5   no request that must not be repeated is executed twice
//   I9   a request that is published and posted is not slept through
//   I18  each request ends exactly once
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "protocol/exchange_observer.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

class ExchangeMonitor final : public protocol::ExchangeObserver {
 public:
  /// Whether executing a request twice does harm: a write of a counter does, a read does not (I5).
  enum class Repeatable : bool { no, yes };

  /// @param slave_task  the task that waits for requests, "emulator/main"
  ExchangeMonitor(ltsim::World& world, std::string slave_task, Repeatable repeatable);

  /// After World::run(): what only the end can show.
  void check_at_end();

  void submitted(std::span<const std::byte> request) noexcept override;
  void published() noexcept override;
  void taken() noexcept override;
  void executed(std::span<const std::byte> request) noexcept override;
  void answered(std::span<const std::byte> response) noexcept override;
  void delivered(std::span<const std::byte> response) noexcept override;
  void ended(protocol::ExchangeOutcome outcome) noexcept override;

 private:
  /// The longest message that is watched.
  static constexpr std::size_t message_bytes_max = 16;
  using Bytes = boost::container::static_vector<std::byte, message_bytes_max>;
  struct Exchange {
    Bytes request;
    Bytes answer;
    unsigned executed_count = 0;
    unsigned delivered_count = 0;
    unsigned ended_count = 0;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  void check_when_idle();
  void violated(std::string message);
  [[nodiscard]] bool holds_bytes_of_another_answer(std::span<const std::byte> response) const noexcept;
  [[nodiscard]] Exchange& current() noexcept { return exchanges_.back(); }
  [[nodiscard]] std::size_t number_of_current() const noexcept { return exchanges_.size(); }

  ltsim::World& world_;
  std::string slave_task_;
  Repeatable repeatable_;
  std::vector<Exchange> exchanges_;   // request number 1 is exchanges_[0]
  std::size_t executing_ = none;      // index
  bool doorbell_unanswered_ = false;  // the last published request has not been turned to yet
};

}  // namespace scenarios
