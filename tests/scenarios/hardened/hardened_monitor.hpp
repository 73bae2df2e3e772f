// Watches one hardened exchange between a kernel and an emulator, both sides at once, and ends the execution when an
// invariant breaks.
//
// Ghost state, kept from the events alone: what each request and each answer was, who executed and delivered what, and
// the state word as its moves make it. No two requests are alike, nor two answers, so bytes tell to which request they
// belong; a checksum that is right proves nothing here. The invariants are numbered as in protocol/README.md.
//
//   I1   an answer is delivered for the request it answers
//   I2   a request gets at most one answer, an answer is delivered at most once
//   I3   what is executed is a request that was submitted, whole
//   I4   what is delivered is an answer that was given, whole
//   I5   no request is executed twice
//   I6   what the kernel was told is not executed, is not, before and after
//   I7   of two that use an area at once neither writes, and who uses it is its owner by the state word
//   I9   nobody sleeps on a doorbell that was rung for him, unless that ring was lost
//   I12  who moves the state word or uses an area holds his role
//   I14  each change of the state word is in the table, and undoes no other
//   I15  a call ends within its time-outs, once for each attempt, but for the time for which somebody was held up
//   I16  no time-out before its full time has passed
//   I17  a fresh request with time to spare ends ok, whatever happened before; unless somebody was held up for all of it, or a
//        ring was lost; with weak memory also before it: a ring is what makes a store visible in time
//   I18  each request ends exactly once; unknown and rejected only for their reasons
//   I28  nobody attaches to a role that somebody else plays
//
// I8 and I10 are asked of the world (run_hardened_exchange). A monitor may be told to judge by one invariant only.
#pragma once

#include <chrono>
#include <cstddef>
#include <initializer_list>
#include <string_view>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "protocol/exchange_observer.hpp"
#include "protocol/hardened/options.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/area_ownership.hpp"
#include "tests/scenarios/hardened/word_ghost.hpp"
#include "tests/scenarios/verdict.hpp"

namespace scenarios {

class HardenedMonitor final : public protocol::ExchangeObserver {
 public:
  /// @param master_process  the events of every other process are the slave's
  /// @param only            the invariant to judge by, "I4"; empty: all
  /// @param word            what is in the segment when the world begins
  /// @param options         of the master
  HardenedMonitor(ltsim::World& world, std::string_view master_process, std::string_view only,
                  std::uint32_t word, const protocol::hardened::Options& options);

  /// As Master::set_timeouts().
  void set_timeouts(ltsim::SimTime take, ltsim::SimTime answer) noexcept {
    take_timeout_ = take;
    answer_timeout_ = answer;
  }
  /// The request that is submitted next has time to spare: it must end ok, unless a slave is killed or stops meanwhile.
  void next_has_time_to_spare() noexcept { has_time_to_spare_ = true; }
  /// After World::run(): what only the end can show.
  void check_at_end();

  void submitted(std::span<const std::byte> request) noexcept override;
  void filling() noexcept override;
  void published() noexcept override;
  void taken() noexcept override;
  void executed(std::span<const std::byte> request) noexcept override;
  void answered(std::span<const std::byte> response) noexcept override;
  void accepted() noexcept override;
  void delivered(std::span<const std::byte> response) noexcept override;
  void ended(protocol::ExchangeOutcome outcome) noexcept override;
  void attached() noexcept override;
  void detaching() noexcept override;
  void moved(std::uint32_t from, std::uint32_t to) noexcept override;

 private:
  /// The longest message that is watched.
  static constexpr std::size_t message_bytes_max = 16;
  using Bytes = boost::container::static_vector<std::byte, message_bytes_max>;
  using Phase = HardenedWordGhost::Phase;

  struct Exchange {
    Bytes request;
    Bytes answer;
    ltsim::TaskId task = 0;  // that sent it
    bool has_time_to_spare = false;
    bool was_given_up = false;       // in BUSY
    bool slave_has_changed = false;  // one has attached, has stopped, or was killed, since it was submitted
    bool was_told_not_executed = false;
    unsigned crashes_before = 0;
    unsigned executed_count = 0;
    unsigned delivered_count = 0;
    unsigned ended_count = 0;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  /// What a call may need besides its time-outs: steps of all tasks, and a pause between two looks in each stage.
  static constexpr ltsim::SimTime time_to_react = std::chrono::milliseconds{20};
  /// What a request with time to spare needs of it: with weak memory a store may be unseen for 64 looks, and a look comes each
  /// millisecond.
  static constexpr ltsim::SimTime time_to_see = std::chrono::milliseconds{100};

  /// Who plays a role; nobody at first.
  struct Holder {
    ltsim::TaskId task = 0;
    bool holds = false;
  };

  [[nodiscard]] bool is_under_way() const noexcept;
  // What nobody asks for any more is forgotten: states that differ in nothing else are the same for a proof.
  void forget_what_the_end_needed(Exchange& exchange) noexcept;
  /// Nobody tells that somebody was killed.
  void forget_the_killed() noexcept;
  void check_when_idle();
  void check_role(std::string_view what);
  void check_early(ltsim::SimTime full, std::string_view what);
  [[nodiscard]] Holder& own_role() { return is_master() ? master_holder_ : slave_holder_; }
  [[nodiscard]] ltsim::SimTime now() const noexcept;
  [[nodiscard]] std::uint32_t losses_left() const noexcept;
  /// That can be in the way of the request that was submitted last.
  [[nodiscard]] bool a_ring_was_lost() const noexcept;
  void check_owner(std::initializer_list<Phase> phases, std::string_view use);
  void uses(AreaOwnership::Use use);
  void check_ended(const Exchange& exchange, protocol::ExchangeOutcome outcome);
  [[nodiscard]] bool is_master() const;
  [[nodiscard]] bool is_alive(ltsim::TaskId task) const;
  [[nodiscard]] unsigned slave_crashes() const;
  template <typename Text>
  void violated(std::initializer_list<std::string_view> invariants, const Text& text) {
    verdict_.violated(invariants, text);
  }

  ltsim::World& world_;
  Verdict verdict_;
  ltsim::Process& master_;
  ltsim::Process* slave_ = nullptr;  // once it has attached
  HardenedWordGhost word_;
  AreaOwnership ownership_;
  std::vector<Exchange> exchanges_;  // request number 1 is exchanges_[0]
  std::size_t executing_ = none;     // index
  ltsim::TaskId slave_task_ = 0;
  bool has_time_to_spare_ = false;
  unsigned queries_max_;
  ltsim::SimTime take_timeout_;
  ltsim::SimTime answer_timeout_;
  // Of the request that was submitted last.
  ltsim::SimTime submitted_at_{0};
  ltsim::SimTime attempt_began_at_{0};  // or before
  ltsim::SimTime held_up_{0};           // since it was submitted
  std::uint32_t losses_left_ = 0;       // of rings, when it was submitted
  std::uint32_t losses_granted_;
  Holder master_holder_;
  Holder slave_holder_;
};

}  // namespace scenarios
