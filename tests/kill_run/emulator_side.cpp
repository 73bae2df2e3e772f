#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/kill_run/dice.hpp"
#include "tests/kill_run/payload.hpp"
#include "tests/kill_run/side.hpp"

namespace kill_run {

namespace {

namespace hardened = protocol::hardened;

/// A PLC whose only effect is its journal: what stands there has been executed.
class JournallingPlc final : public emulator_models::IPlcEmulator {
 public:
  /// @param requests  how many it executes before it lets the slave stop, unless a recovery is to be shown
  JournallingPlc(const Side& side, hardened::Slave& slave, std::uint64_t requests) noexcept
      : side_(side), slave_(slave), requests_left_(requests) {}

  [[nodiscard]] Payload process(std::span<const std::byte> request) noexcept override {
    const std::uint64_t number = number_in(request);
    side_.note({.request = number, .digest = digest(request), .event = Event::executing});
    std::this_thread::sleep_for(std::min(work_in(request), work_max));
    side_.note({.request = number, .event = Event::executed});
    if (requests_left_ > 0) --requests_left_;
    if (requests_left_ == 0) leave_unless_needed();
    return answer_to(number);
  }

 private:
  void leave_unless_needed() noexcept {
    // First it says so, then it looks: a kernel that has seen `serving` after a recovery was asked for finds it there.
    side_.control.serving.store(false);
    if (side_.control.wanted_round.load() == side_.control.shown_round.load()) {
      slave_.request_stop();
    } else {
      side_.control.serving.store(true);
    }
  }

  const Side& side_;
  hardened::Slave& slave_;
  std::uint64_t requests_left_;
};

std::atomic<hardened::Slave*> stopped_by_signal = nullptr;
static_assert(std::atomic<hardened::Slave*>::is_always_lock_free, "used in a signal handler");

void stop_on_sigterm() noexcept {
  struct sigaction stop = {};
  stop.sa_handler = [](int) {
    if (hardened::Slave* const slave = stopped_by_signal.load()) slave->request_stop();
  };
  ::sigaction(SIGTERM, &stop, nullptr);
}

/// One life with the segment.
/// @return whether it could be opened
bool live(const Side& side, Dice& dice, StepObserver& observer) noexcept {
  hardened::Slave slave(side.options.name, protocol_options(side.options), &observer);
  if (const auto opened = slave.open(); !opened) {
    side.note({.event = Event::open_failed, .detail = static_cast<std::uint8_t>(opened.error())});
    return false;
  }
  side.note({.event = Event::attached});
  stopped_by_signal.store(&slave);
  side.control.serving.store(true);
  // A signal that came before there was something to stop.
  if (side.control.stopping.load()) slave.request_stop();
  JournallingPlc plc(side, slave, dice.log_uniform(1, 300));
  emulator_models::EmulatorHandler(slave, plc).run();
  stopped_by_signal.store(nullptr);
  slave.close();
  side.note({.event = Event::closed});
  return true;
}

}  // namespace

int run_emulator(const Side& side) noexcept {
  stop_on_sigterm();
  StepObserver observer(side.control.emulator_steps_left);
  Dice dice(side.seed);
  while (!side.control.stopping.load()) {
    if (!live(side, dice, observer)) return 1;
    if (dice.one_in(2)) std::this_thread::sleep_for(std::chrono::microseconds{dice.log_uniform(1, 2000)});
  }
  return 0;
}

}  // namespace kill_run
