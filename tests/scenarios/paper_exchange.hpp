// The published handoff in a world: kernels that send requests through a SharedMemoryPort, emulators that
// serve them with the EmulatorHandler. Production code on both sides; the PLC behind it is a mirror, so that
// each answer tells its request.
#pragma once

#include <cstdint>

#include "protocol/paper_options.hpp"
#include "sim_clock/world/world.hpp"
#include "tests/scenarios/exchange_monitor.hpp"

namespace scenarios {

/// What is done, and under which circumstances. The defaults are one request inside the envelope in which the
/// design is sound.
struct PaperExchange {
  enum class TimeOuts : bool { never, as_published };
  enum class Killed : std::uint8_t { nobody, kernel, emulator };

  protocol::PaperOptions options = {};   ///< the knobs; areas have room for 8 bytes, whatever they say
  TimeOuts time_outs = TimeOuts::never;  ///< never: the kernel waits for ever, whatever K8 says
  unsigned requests = 1;                 ///< of each kernel thread, one after the other
  unsigned kernel_threads = 1;           ///< K11: on one port
  unsigned emulators = 1;                ///< K11: on one segment, at most 2
  bool reads_twice = false;              ///< after each answer the kernel looks whether there is more
  bool lengths_are_asked = false;        ///< World::choose() says how many bytes each request has, up to 8
  bool emulator_is_late = false;         ///< it is started up to 400 ms after the kernel
  Killed killed = Killed::nobody;        ///< at most once, at any step, and started again 5 ms later
  ExchangeMonitor::Options monitor = {};
};

/// The same requests inside the envelope in which the design is sound.
[[nodiscard]] PaperExchange inside_envelope(const PaperExchange& exchange);

void run_exchange(ltsim::World& world, const PaperExchange& exchange);

}  // namespace scenarios
