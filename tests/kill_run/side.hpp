// What the two processes under fire share with the one that shoots.
#pragma once

#include <atomic>
#include <cstdint>

#include "protocol/exchange_observer.hpp"
#include "tests/kill_run/journal.hpp"
#include "tests/kill_run/run_options.hpp"

namespace kill_run {

/// Zeros are where it begins.
struct Control {
  std::atomic<std::uint64_t> requests_begun;  ///< numbers that were given away
  /// The recovery that a fresh request is to show; 0: none. Until then no side is killed and the emulator stays.
  std::atomic<std::uint32_t> wanted_round;
  std::atomic<std::uint32_t> shown_round;  ///< the last one whose fresh request has ended
  std::atomic<bool> serving;               ///< the emulator is attached and does not mean to leave
  std::atomic<bool> stopping;              ///< both sides are to end in good order
  // How many steps of an exchange are left until a process kills itself; not above 0: it does not.
  std::atomic<std::int32_t> kernel_steps_left;
  std::atomic<std::int32_t> emulator_steps_left;
};

struct Side {
  const RunOptions& options;
  Control& control;
  Journal& journal;
  std::uint32_t incarnation;
  std::uint64_t seed;

  /// Appends it with the time and the incarnation.
  void note(Entry entry) const noexcept {
    entry.time = Clock::now();
    entry.incarnation = incarnation;
    journal.append(entry);
  }
};

/// Kills its own process at the step that it is told: so a kill falls also between two instructions that follow each
/// other, where one from outside nearly never does.
class StepObserver : public protocol::ExchangeObserver {
 public:
  explicit StepObserver(std::atomic<std::int32_t>& steps_left) noexcept : steps_left_(steps_left) {}

  void filling() noexcept override { step(); }
  void published() noexcept override { step(); }
  void taken() noexcept override { step(); }
  void answered(std::span<const std::byte> /*response*/) noexcept override { step(); }
  void announced() noexcept override { step(); }
  void accepted() noexcept override { step(); }
  void attached() noexcept override { step(); }
  void moved(std::uint32_t /*from*/, std::uint32_t /*to*/) noexcept override { step(); }

 private:
  void step() noexcept;

  std::atomic<std::int32_t>& steps_left_;
};

/// The process of the kernel: asks, thinks, closes and opens again, until it is told to stop.
/// @return its exit code: 0 stopped in good order, 1 could not open
int run_kernel(const Side& side) noexcept;
/// The process of the emulator: answers, closes and opens again, until Control::stopping and SIGTERM.
/// @return as run_kernel
int run_emulator(const Side& side) noexcept;

}  // namespace kill_run
