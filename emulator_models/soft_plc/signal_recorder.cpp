#include "emulator_models/soft_plc/signal_recorder.hpp"

#include <algorithm>

namespace emulator_models::soft_plc {

SignalRecorder::SignalRecorder(EventRing& ring, std::uint8_t cycle, std::span<const std::size_t> signals)
    : ring_{ring}, cycle_{cycle} {
  const auto chosen = signals.first(std::min(signals.size(), signals_max));
  signals_.assign(chosen.begin(), chosen.end());
}

void SignalRecorder::observe(std::span<const std::byte> image, std::uint64_t scan_number,
                             std::int64_t time_ns) noexcept {
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const std::size_t byte = signals_[i] / 8;
    const bool now = byte < image.size() && (image[byte] >> (signals_[i] % 8) & std::byte{1}) != std::byte{0};
    if (has_before_ && before_[i] != now) {
      (void)ring_.push({.kind = EventKind::signal_change,
                        .cycle = cycle_,
                        .code = static_cast<std::uint16_t>(i),
                        .time_ns = time_ns,
                        .scan_number = scan_number,
                        .values = {before_[i], now}});
    }
    before_[i] = now;
  }
  has_before_ = true;
}

}  // namespace emulator_models::soft_plc
