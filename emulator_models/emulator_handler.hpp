// The loop of the emulator process: waits for the semaphore, reads the request, hands it to the PLC, writes
// the response; until it is stopped.
//
// A message that the PLC meets with silence gets an empty response: the published loop answers each request,
// and the kernel's read of no bytes is the time-out that silence on a line would give.
#pragma once

#include "emulator_models/i_plc_emulator.hpp"
#include "protocol/exchange_sides.hpp"

namespace emulator_models {

class EmulatorHandler {
 public:
  /// @param slave  open; both must outlive the handler
  EmulatorHandler(protocol::ExchangeSlave& slave, IPlcEmulator& plc) noexcept;

  /// Serves requests until request_stop(). One thread.
  void run() noexcept;
  /// From any thread or signal handler; a request that is being served is answered first.
  void request_stop() noexcept;

 private:
  protocol::ExchangeSlave& slave_;
  IPlcEmulator& plc_;
};

}  // namespace emulator_models
