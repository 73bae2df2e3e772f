#include <array>
#include <thread>

#include "protocol/hardened/master.hpp"
#include "protocol/hardened/state_word.hpp"
#include "tests/kill_run/dice.hpp"
#include "tests/kill_run/payload.hpp"
#include "tests/kill_run/side.hpp"

namespace kill_run {

namespace {

namespace hardened = protocol::hardened;
using std::chrono::microseconds;

/// Journals what a call's outcome is to be judged by.
class KernelObserver final : public StepObserver {
 public:
  explicit KernelObserver(const Side& side) noexcept
      : StepObserver(side.control.kernel_steps_left), side_(side) {}

  void asks(std::uint64_t request) noexcept { request_ = request; }

  void moved(std::uint32_t from, std::uint32_t to) noexcept override {
    using hardened::Phase;
    const Phase before = hardened::decode(from).phase;
    const Phase after = hardened::decode(to).phase;
    const bool by_attach = hardened::decode(from).generation != hardened::decode(to).generation;
    if (before == Phase::busy && after == Phase::orphan && !by_attach)
      side_.note({.request = request_, .event = Event::given_up});
    if (before == Phase::request && after == Phase::idle && !by_attach)
      side_.note({.request = request_, .event = Event::withdrawn});
    StepObserver::moved(from, to);
  }

 private:
  const Side& side_;
  std::uint64_t request_ = 0;
};

class Kernel {
 public:
  explicit Kernel(const Side& side) noexcept : side_(side), dice_(side.seed), observer_(side) {}

  /// One life with the segment.
  /// @return whether it could be opened
  bool live() noexcept {
    hardened::Master master(side_.options.name, protocol_options(side_.options), &observer_);
    if (const auto opened = master.open(); !opened) {
      side_.note({.event = Event::open_failed, .detail = static_cast<std::uint8_t>(opened.error())});
      return false;
    }
    side_.note({.event = Event::attached});
    for (std::uint64_t calls = dice_.log_uniform(1, 300); calls > 0 && goes_on(); --calls) {
      if (const std::uint32_t round = open_round(); round != 0) {
        show_recovery(master, round);
      } else {
        ask_as_usual(master);
      }
    }
    master.close();
    side_.note({.event = Event::closed});
    return true;
  }

 private:
  [[nodiscard]] bool goes_on() const noexcept { return !side_.control.stopping.load(); }

  /// @return the recovery that is still to be shown; 0: none
  [[nodiscard]] std::uint32_t open_round() const noexcept {
    const std::uint32_t wanted = side_.control.wanted_round.load();
    return wanted == side_.control.shown_round.load() ? 0 : wanted;
  }

  void show_recovery(hardened::Master& master, std::uint32_t round) noexcept {
    while (!side_.control.serving.load()) {
      if (!goes_on()) return;
      std::this_thread::sleep_for(microseconds{20});
    }
    master.set_timeouts(fresh_time_outs.take, fresh_time_outs.answer);
    ask(master, microseconds::zero(), round);
    side_.control.shown_round.store(round);
  }

  void ask_as_usual(hardened::Master& master) noexcept {
    const auto work = dice_.one_in(6) ? dice_.log_uniform(100, work_max.count()) : 0;
    master.set_timeouts(usual_time_outs.take, usual_time_outs.answer);
    const bool answered = ask(master, microseconds{work}, 0);
    if (!answered) std::this_thread::sleep_for(microseconds{200});  // the emulator may be away
    if (dice_.one_in(4)) std::this_thread::sleep_for(microseconds{dice_.log_uniform(1, 1000)});
  }

  bool ask(hardened::Master& master, microseconds work, std::uint32_t round) noexcept {
    const std::uint64_t number = side_.control.requests_begun.fetch_add(1) + 1;
    const Payload payload = request(number, work);
    observer_.asks(number);
    const auto bytes = protocol::fx::as_span(payload);
    side_.note({.request = number, .digest = digest(bytes), .round = round, .event = Event::submitted});
    std::array<std::byte, 2 * payload_bytes_max> into{};
    const hardened::CallResult result = master.call(bytes, into);
    const auto answer = std::span(into).first(result.response_bytes);
    side_.note({.request = number,
                .digest = digest(answer),
                .answered = number_in(answer),
                .round = round,
                .event = Event::ended,
                .detail = static_cast<std::uint8_t>(result.outcome)});
    return result.outcome == protocol::ExchangeOutcome::ok;
  }

  const Side& side_;
  Dice dice_;
  KernelObserver observer_;
};

}  // namespace

int run_kernel(const Side& side) noexcept {
  Kernel kernel(side);
  while (!side.control.stopping.load()) {
    if (!kernel.live()) return 1;
  }
  return 0;
}

}  // namespace kill_run
