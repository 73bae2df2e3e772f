// Starts a kernel and an emulator, kills them, starts them again, and says what became of it.
//
// A kill is from outside, after a time of 1 us to 20 ms since the last start or recovery, or from inside, at the 1st to
// 60th step of an exchange since then; each order of magnitude is as likely as any other. Half of the kills fall into
// whatever happens after a start: opening, attaching, the first requests, closing. Before the other half a recovery is
// shown: a fresh request, submitted when both sides are attached, must end ok.
//
// A process is started again when the system has reported the death of the one before it. At times both are killed, and
// the segment is removed before they start again, by a process that may be killed, too; the next kill then falls into their
// start, in which the named objects are made.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/hardened/state_word.hpp"
#include "tests/kill_run/accounts.hpp"
#include "tests/kill_run/child_process.hpp"
#include "tests/kill_run/dice.hpp"
#include "tests/kill_run/journal.hpp"
#include "tests/kill_run/run_options.hpp"
#include "tests/kill_run/side.hpp"

namespace kill_run {

struct RunResult {
  Accounts accounts;
  /// By role and phase of the state word, as it was when the supervisor knew of the death; the last: there was no segment.
  std::array<std::array<std::uint64_t, 9>, 2> kills = {};
  std::uint64_t kills_at_steps = 0;  ///< of these, from inside
  std::uint64_t kills_of_both = 0;   ///< pairs
  std::uint64_t removals = 0;        ///< of the segment, between a kill of both and the next start
  std::uint64_t removals_killed = 0;
  std::vector<std::chrono::nanoseconds> recoveries;  ///< from a kill to the end of the first fresh request
  bool was_interrupted = false;
};

class Supervisor {
 public:
  /// @param interrupted  true ends the run early, in good order
  Supervisor(const RunOptions& options, const std::atomic<bool>& interrupted);

  /// Once.
  /// @throw std::system_error  there is no room for another process
  [[nodiscard]] RunResult run();

 private:
  struct Player {
    std::unique_ptr<ChildProcess> process;
    std::uint32_t incarnation = 0;
  };

  [[nodiscard]] static std::size_t index(Role role) noexcept { return static_cast<std::size_t>(role); }
  [[nodiscard]] Player& player(Role role) noexcept { return players_[index(role)]; }
  [[nodiscard]] std::atomic<std::int32_t>& steps_left(Role role) noexcept;

  void start(Role role);
  /// @return false: it has not come in its time, or a process has ended by itself
  bool recover();
  /// One or two kills, and new processes.
  /// @return false: a process has ended by itself, or the segment could not be removed
  bool kill_and_start_again();
  [[nodiscard]] std::vector<Role> draw_victims();
  bool kill_at_a_moment(const std::vector<Role>& victims, std::chrono::microseconds latest);
  bool kill_at_a_step(Role victim);
  /// What follows a kill.
  /// @param begin  since when it may have been dead
  bool bury(Role role, Clock::time_point begin);
  bool remove_between_lives();
  void stop_in_good_order();
  void remove_at_the_end();
  [[nodiscard]] bool has_ended_by_itself(Role role);
  /// @param ending  another than was to be; nothing: it runs on
  void accuse_of_ending(Role role, const std::optional<Ending>& ending);
  void accuse(std::string accusation) { result_.accounts.accusations.push_back(std::move(accusation)); }

  const RunOptions options_;
  const std::atomic<bool>& interrupted_;
  SharedPages control_pages_;
  Control& control_;
  Journal kernel_journal_;
  Journal emulator_journal_;
  Dice dice_;
  std::array<Player, 2> players_;
  std::vector<Kill> kills_;
  bool was_removed_ = false;  // the segment, before the last start
  RunResult result_;
};

/// @return the files of /dev/shm that belong to the run's segment, or all, if they are the run's own
[[nodiscard]] std::vector<std::string> named_objects(const RunOptions& options);

}  // namespace kill_run
