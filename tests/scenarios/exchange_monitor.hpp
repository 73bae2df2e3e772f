// Watches one exchange between kernels and emulators, both sides at once, and ends the execution when an
// invariant breaks.
//
// Ghost state: what each request and each answer was, who executed and delivered what. Requests must differ
// from each other and answers too, so that bytes tell to which request they belong. The invariants are
// numbered as in protocol/README.md.
//
//   I1   an answer is delivered for the request it answers, to the thread that sent it
//   I2   a request gets at most one answer, an answer is delivered at most once
//   I3   what is executed is a request that was submitted, whole
//   I4   what is delivered is an answer that was given, whole
//   I5   no request that must not be repeated is executed twice
//   I6   what the kernel was told is not executed, is not
//   I7   of two that use an area at once neither writes
//   I9   a request that is published and posted is not slept through
//   I11  a post without a request leads to nothing
//   I14  a change of the state word undoes no other
//   I17  what an emulator leaves when it is killed, the next one takes up
//   I18  each request ends exactly once, as it is; an answer that nobody has read is not wiped
//   I28  one emulator serves at a time
//   I29  the segment is not initialised while it is in use
//
// A message begins with the invariants that the step breaks. I7 and I29 alone do no harm yet: the execution
// goes on, and they are reported at its end if nothing else was. A monitor may be told to judge by one
// invariant only; then the execution goes on after all others, however wrong things are by then.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "protocol/exchange_observer.hpp"
#include "protocol/paper_options.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/area_ownership.hpp"
#include "tests/scenarios/state_word_ghost.hpp"
#include "tests/scenarios/verdict.hpp"

namespace scenarios {

class ExchangeMonitor final : public protocol::ExchangeObserver {
 public:
  /// Whether executing a request twice does harm: a write of a counter does, a read does not (I5).
  enum class Repeatable : bool { no, yes };

  struct Options {
    std::string_view only = {};  ///< the invariant to judge by, "I4"; empty: all
    Repeatable repeatable = Repeatable::no;
    /// So many answers may be delivered for a wrong request before I1 is reported: what follows from the
    /// first one shows then.
    unsigned foreign_answers_tolerated = 0;
  };

  ExchangeMonitor(ltsim::World& world, const protocol::PaperOptions& paper, const Options& options);

  /// The slave's open() has returned: with K5 = slave it has filled the segment with zeros.
  void slave_opened();
  /// After World::run(): what only the end can show.
  void check_at_end();

  void submitted(std::span<const std::byte> request) noexcept override;
  void published() noexcept override;
  void taken() noexcept override;
  void executed(std::span<const std::byte> request) noexcept override;
  void answered(std::span<const std::byte> response) noexcept override;
  void announced() noexcept override;
  void accepted() noexcept override;
  void delivered(std::span<const std::byte> response) noexcept override;
  void ended(protocol::ExchangeOutcome outcome) noexcept override;

 private:
  /// The longest message that is watched.
  static constexpr std::size_t message_bytes_max = 16;
  using Bytes = boost::container::static_vector<std::byte, message_bytes_max>;
  struct Exchange {
    Bytes request;
    Bytes answer;
    ltsim::TaskId task = 0;       // that sent it
    std::size_t tasks_count = 0;  // when it was sent: a task with a higher number began later
    bool published = false;
    bool taken = false;         // a slave was woken since it was published
    bool sender_waits = false;  // for the answer; two threads of a kernel may wait at once
    bool not_executed = false;  // the kernel was told so
    unsigned executed_count = 0;
    unsigned delivered_count = 0;
    unsigned ended_count = 0;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  enum class MasterStep : std::uint8_t { at_rest, submitted, waits, reads };
  enum class SlaveStep : std::uint8_t { waits, taken, executes, answers };

  /// Tells a fuzzing engine where both sides are. Nobody else: a seed of an exploration is to mean what it meant.
  void tell_state(MasterStep step);
  void tell_state(SlaveStep step);
  void tell_state();
  void check_when_idle();
  void check_state_word();
  void check_delivered(std::span<const std::byte> response, bool wiped_another);
  template <typename Text>
  void violated(std::initializer_list<std::string_view> invariants, const Text& text) {
    verdict_.violated(invariants, text);
  }
  [[nodiscard]] const ltsim::Task& running() const noexcept;
  /// The request that the running task sent last.
  [[nodiscard]] std::size_t index_of_own() const noexcept;
  [[nodiscard]] const ltsim::Task* sleeping_slave() const noexcept;
  [[nodiscard]] bool waits_for_answer(const Exchange& exchange) const noexcept;

  ltsim::World& world_;
  Verdict verdict_;
  protocol::PaperOptions paper_;
  Options options_;
  std::vector<Exchange> exchanges_;      // request number 1 is exchanges_[0]
  std::vector<Bytes> invented_answers_;  // to what nobody submitted
  AreaOwnership ownership_;
  StateWordGhost state_word_;
  ltsim::ProcessId serving_ = 0;
  bool served_ = false;  // serving_ holds the process that was woken last
  std::size_t published_count_ = 0;
  std::size_t taken_count_ = 0;
  std::size_t executing_ = none;  // index
  std::size_t unread_ = none;     // index; its answer was announced, and nobody has turned to it yet
  MasterStep master_step_ = MasterStep::at_rest;
  SlaveStep slave_step_ = SlaveStep::waits;
  bool reset_in_use_ = false;  // the segment was filled with zeros after a request was published
};

}  // namespace scenarios
