#include "emulator_models/emulator_handler.hpp"

namespace emulator_models {

EmulatorHandler::EmulatorHandler(protocol::ExchangeSlave& slave, IPlcEmulator& plc) noexcept
    : slave_{slave}, plc_{plc} {}

void EmulatorHandler::run() noexcept {
  while (slave_.wait_for_request()) {
    const protocol::fx::FrameBytes response = plc_.process(slave_.read_request());
    slave_.write_response(protocol::fx::as_span(response));
  }
}

void EmulatorHandler::request_stop() noexcept { slave_.request_stop(); }

}  // namespace emulator_models
