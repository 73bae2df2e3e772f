#include "tests/scenarios/hardened/hardened_exchange.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "emulator_models/emulator_handler.hpp"
#include "protocol/hardened/master.hpp"
#include "protocol/hardened/message.hpp"
#include "protocol/hardened/slave.hpp"
#include "tests/scenarios/hardened/hardened_monitor.hpp"
#include "tests/scenarios/mirror_plc.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace scenarios {
namespace {

using namespace std::chrono_literals;
using protocol::ExchangeOutcome;
namespace hardened = protocol::hardened;

constexpr const char* segment = "handoff";
constexpr ltsim::WaitKey news = ~ltsim::WaitKey{0} >> 16U;  // no address
constexpr std::size_t payload_bytes_max = 16;
constexpr auto time_to_spare = 1s;  // for each stage of a call
/// Requests have numbers below 128: the answers have the others.
constexpr unsigned requests_of_a_life_max = 16;

hardened::Options options_of(const HardenedExchange& exchange) {
  hardened::Options options = exchange.options;
  options.request_bytes_max = payload_bytes_max;
  options.response_bytes_max = payload_bytes_max;
  if (exchange.time_outs == HardenedExchange::TimeOuts::never)
    options.take_timeout = options.answer_timeout = 1h;
  options.open_timeout = 1h;  // how slow an opener is, is not what these scenarios are about
  return options;
}

protocol::SegmentLayout layout_of(const hardened::Options& options) {
  return protocol::segment_layout(hardened::header_bytes + options.request_bytes_max,
                                  hardened::header_bytes + options.response_bytes_max);
}

/// The two sides of one execution, and what they know of each other outside of the segment: the operator, who starts
/// the kernel when the emulator is up, and stops the emulator when the kernel has finished. What belongs to a process
/// is made in it, so that a process that is killed and started again begins anew.
class HardenedSides {
 public:
  HardenedSides(ltsim::World& world, const HardenedExchange& exchange)
      : world_{world},
        exchange_{exchange},
        options_{options_of(exchange)},
        monitor_{world, "kernel", exchange.only, exchange.word, options_},
        kernels_to_come_{exchange.has_rivals ? 2U : 1U} {}

  void run_kernel() {
    next_request_ = std::max(next_request_, first_request_of_this_life());
    // Those of the life before make no difference while this one opens.
    if (!exchange_.has_rivals) monitor_.set_timeouts(options_.take_timeout, options_.answer_timeout);
    if (!exchange_.opens_together) wait_for_emulator();
    if (kernels_to_come_ != 0) {
      hardened::Master master{segment, options_, &monitor_};
      if (!open(master)) return;
      wait_for_emulator();
      monitor_.set_timeouts(options_.take_timeout, options_.answer_timeout);
      for (unsigned i = 0; i < exchange_.requests; ++i) ask(master);
      ask_with_time_to_spare(master);
    }
    if (kernels_to_come_ != 0) --kernels_to_come_;
    tell_all();
  }

  void operate() {
    sleep_until([this] { return kernels_to_come_ == 0; });
    if (exchange_.lost_rings != 0) world_.finish();  // the ring of a stop could be lost, too
    stopped_ = true;
    stop_emulator();
  }

  void stop_emulator_once() {
    wait_for_emulator();
    stop_emulator();
  }

  void run_emulator() {
    while (!stopped_) {
      MirrorPlc plc;
      hardened::Slave slave{segment, options_, &monitor_};
      emulator_models::EmulatorHandler handler{slave, plc};
      if (!open(slave)) return;
      handler_ = &handler;
      serving_task_ = ltsim::current_task->id;
      if (!stopped_) {
        if (may_open_before_emulator()) meetings_.fetch_add(1, std::memory_order_release);
        emulator_is_up_ = true;
        tell_all();
        handler.run();
        emulator_is_up_ = false;
      }
      handler_ = nullptr;
      sleep_until([this] { return stops_under_way_ == 0; });
    }
  }

  void check_at_end() { monitor_.check_at_end(); }

 private:
  void wait_for_emulator() {
    do {
      sleep_until([this] { return emulator_is_up_ || kernels_to_come_ == 0; });
      if (may_open_before_emulator()) meetings_.fetch_add(1, std::memory_order_acquire);
    } while (!emulator_is_up_ && kernels_to_come_ != 0);  // it may have stopped at that step
  }

  /// Then nothing in the protocol makes the kernel see that the emulator has attached when it is told so: a store is seen after
  /// some time. Otherwise the locks for opening do, and nothing else may.
  [[nodiscard]] bool may_open_before_emulator() const {
    return exchange_.opens_together || exchange_.emulator_stops;
  }

  /// Until somebody tells that it is so. Neither orders memory, as a lock, a semaphore or a futex would, nor looks at a clock.
  template <class Condition>
  void sleep_until(const Condition& is_so) {
    while (!is_so()) {
      world_.scheduler().point({.kind = ltsim::OperationKind::sleep});
      if (!is_so()) world_.scheduler().block(news, ltsim::VirtualClock::never);
    }
  }

  /// What the operator sees has changed.
  void tell_all() { world_.scheduler().wake(news, ltsim::tasks_max); }

  /// @return false: it is over
  template <class Side>
  bool open(Side& side) {
    for (;;) {
      const auto opened = side.open();
      if (opened) return true;
      if (exchange_.has_rivals && opened.error() == protocol::SharedMemoryError::role_taken) {
        if (stopped_) return false;
        std::this_thread::sleep_for(5ms);
        continue;
      }
      stopped_ = true;
      kernels_to_come_ = 0;
      tell_all();
      world_.violated("I28, I29: a side cannot open the segment");
      return false;
    }
  }

  /// Nothing is to come in the way of the last of these requests: each kill, each stop and each ring that is lost can be in the
  /// way of one.
  void ask_with_time_to_spare(hardened::Master& master) {
    master.set_timeouts(time_to_spare, time_to_spare);
    monitor_.set_timeouts(time_to_spare, time_to_spare);
    const unsigned stops = exchange_.emulator_stops ? 1 : 0;
    for (unsigned excuses = exchange_.emulator_kills + stops + exchange_.lost_rings;; --excuses) {
      wait_for_emulator();
      monitor_.next_has_time_to_spare();
      if (ask(master) == ExchangeOutcome::ok || excuses == 0) return;
    }
  }

  void stop_emulator() {
    if (handler_ == nullptr || world_.scheduler().task(serving_task_).state == ltsim::Task::State::killed)
      return;
    ++stops_under_way_;
    handler_->request_stop();
    --stops_under_way_;
    tell_all();
  }

  /// So that how many requests the life before has made, makes no difference to this one.
  [[nodiscard]] unsigned first_request_of_this_life() const {
    return 1 + (world_.incarnation(ltsim::current_task->process) - 1) * requests_of_a_life_max;
  }

  /// Request n is so many bytes n: no part of one is a part of another, and two in a row of one life differ in length.
  ExchangeOutcome ask(hardened::Master& master) {
    std::array<std::byte, payload_bytes_max> request;
    std::array<std::byte, payload_bytes_max> answer;
    const unsigned number = next_request_++;
    request.fill(static_cast<std::byte>(number));
    return master.call(std::span(request).first(number % 2 == 1 ? 12 : 10), answer).outcome;
  }

  ltsim::World& world_;
  const HardenedExchange& exchange_;
  hardened::Options options_;
  HardenedMonitor monitor_;
  emulator_models::EmulatorHandler* handler_ = nullptr;
  ltsim::TaskId serving_task_ = 0;
  unsigned stops_under_way_ = 0;  // the handler must outlive them
  unsigned next_request_ = 1;
  unsigned kernels_to_come_;
  bool emulator_is_up_ = false;
  /// Added to by who comes up and by who has seen that: read-modify-writes, so what the first did before is seen by the second.
  std::atomic<std::uint32_t> meetings_ = 0;
  bool stopped_ = false;
};

void leave_word(ltsim::World& world, std::uint32_t word, std::size_t segment_bytes) {
  std::vector<std::byte> content(segment_bytes);
  std::memcpy(content.data(), &word, sizeof word);
  world.leave_segment(segment, content);
}

}  // namespace

void run_hardened_exchange(ltsim::World& world, const HardenedExchange& exchange) {
  const protocol::SegmentLayout layout = layout_of(options_of(exchange));
  name_regions(world, segment, layout);
  const auto length_is_loaded_once = [&](const protocol::AreaLayout& area, std::string_view name) {
    world.single_fetch(segment, static_cast<std::uint32_t>(area.length_offset), 4, name);  // I8
  };
  length_is_loaded_once(layout.request, "segment.request-length");
  length_is_loaded_once(layout.response, "segment.response-length");
  // I10, with the ring of the operator's stop, and of the emulator's first attach.
  const unsigned stops = exchange.emulator_stops ? 1 : 0;
  const unsigned emulators = exchange.has_rivals ? 2 : 1;
  world.bound_semaphore(std::string{segment} + ".request", 1 + 1 + stops + exchange.odd_rings);
  world.bound_semaphore(std::string{segment} + ".response",
                        2 + emulators + exchange.emulator_kills + stops + exchange.odd_rings);
  if (exchange.odd_rings != 0) {
    world.grant(ltsim::FaultKind::doubled_post, exchange.odd_rings);
    world.grant(ltsim::FaultKind::interrupt, exchange.odd_rings);
  }
  if (exchange.lost_rings != 0) world.grant(ltsim::FaultKind::lost_post, exchange.lost_rings);
  if (exchange.clock_steps != 0) world.grant(ltsim::FaultKind::clock_step, exchange.clock_steps);
  if (exchange.foreign_writes != 0) {
    world.grant_in(ltsim::FaultKind::foreign_write, segment, 0, static_cast<std::uint32_t>(layout.size_bytes),
                   exchange.foreign_writes);
  }
  // What races where a rule is missing is known; what comes of it is looked for.
  if (!exchange.only.empty()) world.allow_data_races();
  if (exchange.word != 0) leave_word(world, exchange.word, layout.size_bytes);

  HardenedSides sides{world, exchange};
  ltsim::Process& kernel = world.process("kernel");
  ltsim::Process& emulator = world.process("emulator");
  kernel.start("main", [&] {
    sides.run_kernel();
    if (exchange.kernel_kills == 0) sides.operate();
  });
  emulator.start("main", [&] { sides.run_emulator(); });
  if (exchange.emulator_stops) emulator.start("stopper", [&] { sides.stop_emulator_once(); });
  if (exchange.has_rivals) {
    kernel.start("rival", [&] { sides.run_kernel(); });
    world.process("standby").start("main", [&] { sides.run_emulator(); });
  }
  if (exchange.kernel_kills != 0) {
    // Nobody would stop the emulator if the operator were killed with the kernel.
    world.process("operator").start("main", [&] { sides.operate(); });
    kernel.may_crash({.times = exchange.kernel_kills, .restart_after = 5ms});
  }
  if (exchange.emulator_kills != 0)
    emulator.may_crash({.times = exchange.emulator_kills, .restart_after = 5ms});
  world.run();
  sides.check_at_end();
}

}  // namespace scenarios
