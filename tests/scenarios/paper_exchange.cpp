#include "tests/scenarios/paper_exchange.hpp"

#include <array>
#include <chrono>
#include <thread>
#include <vector>

#include "emulator_models/emulator_handler.hpp"
#include "protocol/shared_memory_port.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/scenarios/mirror_plc.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace scenarios {
namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;

constexpr const char* segment = "handoff";
constexpr std::array emulator_names{"emulator", "second-emulator"};

/// Request 1 is 11 12 13, request 2 is 21 22, request 3 is 31 32 33 ... up to 7: no part of one is a part of
/// another, and two in a row differ in length.
/// @param length  0: this one
std::span<const std::byte> request_bytes(unsigned number, std::size_t length, std::span<std::byte, 8> into) {
  if (length == 0) length = number % 2 == 1 ? 3 : 2;
  for (unsigned i = 0; i < length; ++i) into[i] = static_cast<std::byte>(number << 4U | (i + 1));
  return into.first(length);
}

PaperOptions options_of(const PaperExchange& exchange) {
  PaperOptions options = exchange.options;
  options.request_bytes_max = 8;
  options.response_bytes_max = 8;
  if (exchange.time_outs == PaperExchange::TimeOuts::never)
    options.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  return options;
}

/// The two sides of one execution, and what they know of each other outside of the segment: the operator, who
/// stops the emulators when the kernel has finished. What belongs to a process is made in it, so that a process
/// that is killed and started again begins anew.
class Sides {
 public:
  Sides(ltsim::World& world, const PaperExchange& exchange)
      : world_{world},
        exchange_{exchange},
        options_{options_of(exchange)},
        monitor_{world, options_, exchange.monitor} {
    if (exchange.emulator_is_late) emulator_delay_ = 50ms * world.choose("delay", 9);
  }

  void run_kernel() {
    if (kernel_has_finished_) return;
    protocol::SharedMemoryPort port{segment, options_, &monitor_};
    both_open_ = port.open().has_value() && both_open_;
    std::vector<std::thread> others;
    for (unsigned thread = 1; thread < exchange_.kernel_threads; ++thread)
      others.emplace_back([this, &port] { send_requests(port); });
    send_requests(port);
    for (std::thread& other : others) other.join();
    kernel_has_finished_ = true;
  }

  /// @param index  which of the emulators
  void run_emulator(unsigned index) {
    serving_[index] = nullptr;
    if (emulator_delay_ > 0ns) std::this_thread::sleep_for(emulator_delay_);
    if (stopped_) return;
    MirrorPlc plc;
    protocol::SlaveSharedMemoryWrapper slave{segment, options_, &monitor_};
    emulator_models::EmulatorHandler handler{slave, plc};
    serving_[index] = &handler;
    both_open_ = slave.open().has_value() && both_open_;
    monitor_.slave_opened();
    handler.run();
  }

  void operate() {
    do {
      std::this_thread::sleep_for(50ms);  // the machine stays on for a while
    } while (!kernel_has_finished_);
    stopped_ = true;
    for (emulator_models::EmulatorHandler* handler : serving_) {
      if (handler != nullptr) handler->request_stop();
    }
  }

  void check_at_end(ltsim::World& world) {
    world.require(both_open_, "both sides can open the segment");
    monitor_.check_at_end();
  }

 private:
  void send_requests(protocol::SharedMemoryPort& port) {
    for (unsigned i = 0; i < exchange_.requests; ++i) {
      std::byte request[8];
      std::byte answer[8];
      const std::size_t length = exchange_.lengths_are_asked ? world_.choose("length", 9) : 0;
      if (!port.write(request_bytes(next_request_++, length, request)) || !port.read(answer)) return;
      if (!exchange_.reads_twice) continue;
      port.set_timeouts({.read = 0ns});
      if (!port.read(answer)) return;
      port.set_timeouts({.read = options_.read_timeout});
    }
  }

  ltsim::World& world_;
  const PaperExchange& exchange_;
  PaperOptions options_;
  ExchangeMonitor monitor_;
  std::chrono::nanoseconds emulator_delay_{0};
  std::array<emulator_models::EmulatorHandler*, emulator_names.size()> serving_{};
  unsigned next_request_ = 1;
  bool both_open_ = true;
  bool kernel_has_finished_ = false;
  bool stopped_ = false;
};

}  // namespace

PaperExchange inside_envelope(const PaperExchange& exchange) {
  PaperExchange sound{.requests = exchange.requests,
                      .reads_twice = exchange.reads_twice,
                      .lengths_are_asked = exchange.lengths_are_asked,
                      .emulator_is_late = exchange.emulator_is_late,
                      .monitor = exchange.monitor};
  if (sound.reads_twice) {
    // The second read ends by its time-out; the first has none to fear.
    sound.time_outs = PaperExchange::TimeOuts::as_published;
    sound.options.read_timeout = 1h;
  }
  return sound;
}

void run_exchange(ltsim::World& world, const PaperExchange& exchange) {
  constexpr ltsim::CrashGrant once{.times = 1, .restart_after = 5ms};
  using Killed = PaperExchange::Killed;
  name_regions(world, segment, options_of(exchange));
  Sides sides{world, exchange};
  ltsim::Process& kernel = world.process("kernel");
  kernel.start("main", [&] {
    sides.run_kernel();
    if (exchange.killed != Killed::kernel) sides.operate();
  });
  for (unsigned i = 0; i < exchange.emulators; ++i)
    world.process(emulator_names.at(i)).start("main", [&sides, i] { sides.run_emulator(i); });
  if (exchange.killed == Killed::kernel) {
    // Nobody would stop the emulator if the operator were killed with the kernel.
    world.process("operator").start("main", [&] { sides.operate(); });
    kernel.may_crash(once);
  }
  if (exchange.killed == Killed::emulator) world.process(emulator_names[0]).may_crash(once);
  world.run();
  sides.check_at_end(world);
}

}  // namespace scenarios
