// I19 to I26 of a soft PLC with two cycles, judged by what can be seen from outside: orders as they are given, calls of
// the programs, terminals at every change, the lamp.
//
// And what gateway.hpp promises to field devices: "gateway: ...".
//
// Where a moment matters it is the right one: what a call of this monitor reports has happened in the same step of the
// world, for nothing but the unlocking of a mutex lies between. So a run is the number of RUN orders that were accepted
// before its start, and a stop is final from the very step in which the gate was closed.
//
// What is tolerated, since any thread may be slow for any time:
//   I20  is judged when every task waits of its own accord: then the watchdog has had its chance, and delta is 1 us.
//        Where a scan that hangs computes on the only processor, delta is 20 us, 200 steps of the world, in which the
//        host holds nobody up: whatever then keeps the watchdog waiting is the PLC's matter.
//   I21  the lamp may go on while the latest scan of some cycle began longer ago than the limit: from outside it
//        cannot be told from one that has not ended.
//   I26  starts, not due moments: a start that the host delays keeps its point of the grid, so that one scan more
//        than floor(w/T)+1 can start in a window; with the rule catch_up, `burst` more.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "sim_clock/world/world.hpp"

namespace scenarios {

class PlcMonitor {
 public:
  using Nanoseconds = std::chrono::nanoseconds;
  static constexpr std::size_t cycles_count = 2;
  static constexpr Nanoseconds watchdog_delta{1000};
  /// What the watchdog has to do until it has closed the gate, and those before it who hold a mutex.
  static constexpr Nanoseconds watchdog_work{20'000};
  struct Options {
    std::array<Nanoseconds, cycles_count> periods{};
    Nanoseconds watchdog_limit{0};
    std::uint64_t burst = 0;     ///< scans that may follow one another at once
    std::string_view only = {};  ///< "I21": the one invariant that is judged
  };

  PlcMonitor(ltsim::World& world, const Options& options) : world_(world), options_(options) {}

  /// How to look at the alarm lamp; empty = there is no PLC. Other calls are for the time between the two.
  void set_lamp(std::function<bool()> is_on) { lamp_ = std::move(is_on); }

  // --- right after the order has been accepted, or the call has come back ---
  void run_ordered();
  void stop_ordered();
  /// The outputs are said to be safe from here on.
  void stopped();

  /// The PLC has looked at its clock, which need not be right.
  void clock_read(Nanoseconds read);

  // --- by the program of a cycle ---
  void initialised(std::size_t cycle);
  /// @param scan_start  as the program was told, by the PLC's clock
  void slice_begins(std::size_t cycle, Nanoseconds scan_start, bool first_scan);
  void input_read(std::size_t cycle, std::uint64_t value);
  /// The pair that field devices write.
  void field_words_read(std::size_t cycle, std::uint64_t first, std::uint64_t second);
  /// The output words of a scan that is complete are outputs_of(number), with the numbers 1, 2 ...
  void scan_computed(std::size_t cycle);
  void gave_up(std::size_t cycle);
  /// A program computes on the only processor; no task of lower priority comes to run meanwhile.
  void computes();
  [[nodiscard]] std::uint32_t next_outputs(std::size_t cycle) const noexcept {
    return outputs_of(cycles_[cycle].computed_in.size() + 1);
  }

  /// The terminals show something else, or the same again: one word for each cycle, 0 = safe.
  void terminals_written(const std::array<std::uint32_t, cycles_count>& words);

  // --- by field devices, right after their call has come back ---
  /// @param program_words  the pair that a program writes
  /// @param field_words    the pair that the same request has written before
  void gateway_answered(std::uint64_t written, const std::array<std::uint64_t, 2>& program_words,
                        const std::array<std::uint64_t, 2>& field_words);
  /// @param written  never the same twice
  void gateway_given_up(std::uint64_t written) { given_up_.insert(written); }

  /// For World::whenever_idle.
  void idle();

 private:
  struct Cycle {
    std::uint64_t run = 0;  ///< the latest that was initialised
    bool is_initialised = false;
    bool must_be_first = false;
    bool is_in_scan = false;
    bool stop_seen = true;  ///< initialised since the latest STOP order
    unsigned slices_in_scan = 0;
    Nanoseconds first_slice{0};
    /// The scan that is watched has not begun earlier: the latest that is known of, or one after it was given up.
    Nanoseconds began_after{0};
    std::optional<std::uint64_t> input;       ///< read in this scan
    std::optional<std::uint64_t> field_word;  ///< read in this scan
    std::vector<std::uint64_t> computed_in;   ///< runs of scan 1, 2 ...
    std::vector<Nanoseconds> starts;
  };
  /// Both halves differ for each scan, and from those of another one.
  [[nodiscard]] static std::uint32_t outputs_of(std::uint64_t scan) noexcept {
    return static_cast<std::uint32_t>(scan << 16U | (0xFFFFU - (scan & 0xFFFFU)));
  }
  void begin_scan(Cycle& cycle, std::size_t index, Nanoseconds scan_start, bool first_scan);
  void check_spacing(const Cycle& cycle, std::size_t index);
  void look_at_lamp();
  void require_watchdog(Nanoseconds delta);
  /// @param message  begins with the invariant
  void require(bool holds, std::string_view message);
  [[nodiscard]] bool may_be_over_time(const Cycle& cycle) const noexcept;

  ltsim::World& world_;
  const Options options_;
  std::function<bool()> lamp_;
  std::array<Cycle, cycles_count> cycles_{};
  std::array<std::uint32_t, cycles_count> terminals_{};
  std::uint64_t runs_count_ = 0;
  std::uint64_t last_dead_run_ = 0;
  Nanoseconds stop_ordered_at_{-1};
  Nanoseconds held_up_at_{-watchdog_work};  ///< some task, by the host; seen while a program computed
  std::map<Nanoseconds, Nanoseconds> wrong_readings_;  ///< when what was first read, if it was not the time
  std::set<std::uint64_t> given_up_;                   ///< writes that nothing may come of
  bool lamp_was_off_ = false;                          ///< since the latest RUN order
  bool was_over_time_ = false;                         ///< some scan of the run may have been
};

}  // namespace scenarios
