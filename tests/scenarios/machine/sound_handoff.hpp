// Whether the published handoff is still inside the envelope in which it is sound. Outside of it an answer may be that
// to another request, and then what the kernel takes for FIN need not be one: hazards H3 to H5, H7, H8, H11, H14 of
// protocol/README.md. I27 is demanded up to there; the interlocks, which are the PLC's alone, are demanded always.
//
// Left, once and for all, when a request is handed over while the one before is not taken yet or is not answered yet, or
// when the slave begins without a request. Listens to both sides, in all their lives.
#pragma once

#include "protocol/exchange_observer.hpp"
#include "tests/scenarios/function_monitor.hpp"

namespace scenarios {

class SoundHandoff final : public protocol::ExchangeObserver {
 public:
  explicit SoundHandoff(FunctionMonitor& functions) noexcept : functions_{functions} {}

  void submitted(std::span<const std::byte> /*request*/) noexcept override {
    if (is_published_ || is_taken_) functions_.excuse();
  }
  void published() noexcept override { is_published_ = true; }
  void taken() noexcept override {
    if (!is_published_) functions_.excuse();
    is_published_ = false;
    is_taken_ = true;
  }
  void announced() noexcept override { is_taken_ = false; }

  /// Its process was killed: what it had taken it will never answer (H12).
  void slave_died() noexcept { is_taken_ = false; }

 private:
  FunctionMonitor& functions_;
  bool is_published_ = false;  ///< and not taken
  bool is_taken_ = false;      ///< and not answered
};

}  // namespace scenarios
