#include "tests/scenarios/hardened/hardened_exchange.hpp"

#include <array>
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
constexpr std::size_t payload_bytes_max = 16;

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
        emulator_{world.process("emulator")},
        monitor_{world, "kernel", exchange.only, exchange.word} {}

  void run_kernel() {
    while (!emulator_is_up_) std::this_thread::sleep_for(1ms);
    if (!kernel_has_finished_) {
      hardened::Master master{segment, options_, &monitor_};
      if (!master.open()) return cannot_open();
      for (unsigned i = 0; i < exchange_.requests; ++i) ask(master);
      master.set_timeouts(1h, 1h);
      // Each emulator may be killed with such a request in its hands.
      for (unsigned i = 0; i <= exchange_.emulator_kills; ++i) {
        monitor_.next_has_time_to_spare();
        if (ask(master) == ExchangeOutcome::ok) break;
      }
    }
    kernel_has_finished_ = true;
  }

  void operate() {
    do {
      std::this_thread::sleep_for(50ms);  // the machine stays on for a while
    } while (!kernel_has_finished_);
    stopped_ = true;
    if (handler_ != nullptr && serving_life_ == emulator_.incarnation()) handler_->request_stop();
  }

  void run_emulator() {
    if (stopped_) return;
    MirrorPlc plc;
    hardened::Slave slave{segment, options_, &monitor_};
    emulator_models::EmulatorHandler handler{slave, plc};
    if (!slave.open()) return cannot_open();
    handler_ = &handler;
    serving_life_ = emulator_.incarnation();
    if (stopped_) return;
    emulator_is_up_ = true;
    handler.run();
    handler_ = nullptr;
  }

  void check_at_end() { monitor_.check_at_end(); }

 private:
  void cannot_open() {
    stopped_ = true;
    kernel_has_finished_ = true;
    world_.violated("I28, I29: a side cannot open the segment");
  }

  /// Request n is so many bytes n: no part of one is a part of another, and two in a row differ in length.
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
  ltsim::Process& emulator_;
  HardenedMonitor monitor_;
  emulator_models::EmulatorHandler* handler_ = nullptr;
  unsigned serving_life_ = 0;
  unsigned next_request_ = 1;
  bool emulator_is_up_ = false;
  bool kernel_has_finished_ = false;
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
  world.bound_semaphore(std::string{segment} + ".request", 1 + 1 + exchange.odd_rings);
  world.bound_semaphore(std::string{segment} + ".response",
                        2 + 1 + exchange.emulator_kills + exchange.odd_rings);
  if (exchange.odd_rings != 0) {
    world.grant(ltsim::FaultKind::doubled_post, exchange.odd_rings);
    world.grant(ltsim::FaultKind::interrupt, exchange.odd_rings);
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
