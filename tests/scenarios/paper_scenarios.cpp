// The published handoff: a kernel that sends requests through a SharedMemoryPort, an emulator that serves
// them with the EmulatorHandler. Production code on both sides; the PLC behind it is a mirror, so that each
// answer tells its request.

#include <chrono>
#include <thread>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "protocol/shared_memory_port.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/exchange_monitor.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;
using Repeatable = scenarios::ExchangeMonitor::Repeatable;

/// Answers with the request's bytes, the top bit of each set.
class MirrorPlc final : public emulator_models::IPlcEmulator {
 public:
  protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override {
    protocol::fx::FrameBytes answer;
    for (const std::byte byte : request) answer.push_back(byte | std::byte{0x80});
    return answer;
  }
};

/// Request 1 is 11 12 13, request 2 is 21 22, request 3 is 31 32 33 ...: no part of one is a part of another,
/// and two in a row differ in length.
std::span<const std::byte> request_bytes(unsigned number, std::span<std::byte, 3> into) {
  const std::size_t length = number % 2 == 1 ? 3 : 2;
  for (unsigned i = 0; i < length; ++i) into[i] = static_cast<std::byte>(number << 4U | (i + 1));
  return into.first(length);
}

PaperOptions defaults() {
  PaperOptions options;
  options.request_bytes_max = 8;
  options.response_bytes_max = 8;
  return options;
}

struct Exchange {
  PaperOptions options = defaults();
  unsigned requests = 1;
  Repeatable repeatable = Repeatable::no;
  /// When the emulator is started, after the kernel.
  std::chrono::nanoseconds emulator_start_delay{0};
};

void run_exchange(ltsim::World& world, const Exchange& exchange) {
  constexpr const char* segment = "handoff";
  scenarios::name_regions(world, segment, exchange.options);
  scenarios::ExchangeMonitor monitor{world, "emulator/main", exchange.repeatable};
  MirrorPlc plc;
  protocol::SlaveSharedMemoryWrapper slave{segment, exchange.options, &monitor};
  emulator_models::EmulatorHandler handler{slave, plc};
  bool both_open = true;

  world.process("kernel").start("main", [&] {
    protocol::SharedMemoryPort port{segment, exchange.options, &monitor};
    both_open = port.open().has_value() && both_open;
    for (unsigned number = 1; number <= exchange.requests; ++number) {
      std::byte request[3];
      std::byte answer[8];
      if (!port.write(request_bytes(number, request)) || !port.read(answer)) break;
    }
    std::this_thread::sleep_for(50ms);  // the machine stays on for a while
    handler.request_stop();             // the operator ends the emulator
  });
  world.process("emulator").start("main", [&] {
    if (exchange.emulator_start_delay > 0ns) std::this_thread::sleep_for(exchange.emulator_start_delay);
    both_open = slave.open().has_value() && both_open;
    handler.run();
  });
  world.run();
  world.require(both_open, "both sides can open the segment");
  monitor.check_at_end();
}

}  // namespace

SCENARIO("paper/one-request", "the published handoff with its defaults, one request") {
  run_exchange(world, {});
}

SCENARIO("paper/three-requests", "three requests and no time-out: the published handoff is sound here") {
  Exchange exchange{.requests = 3};
  exchange.options.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  run_exchange(world, exchange);
}

SCENARIO("paper/time-out", "K8: the kernel gives up a read after 100 ms and sends the next one") {
  run_exchange(world, {.requests = 3, .repeatable = Repeatable::yes});
}

SCENARIO("paper/semaphore-reset",
         "K3: the emulator sets the semaphore to 0 after each answer; nothing times out") {
  Exchange exchange{.requests = 2};
  exchange.options.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset;
  exchange.options.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  run_exchange(world, exchange);
}

SCENARIO("paper/late-emulator",
         "the emulator is started up to 400 ms after the kernel, which times out after 100 ms") {
  Exchange exchange{.requests = 3};
  exchange.emulator_start_delay = 50ms * world.choose("delay", 9);
  run_exchange(world, exchange);
}
