// Records a SoftPlc, one ring for each cycle: what the cycle does, what field devices write through the gateway, how
// chosen bits change; and the values at chosen addresses after each of its scans, for any thread.
//
// In a port_write record the cycle is that whose memory was written, the area is soft_plc::Area, the address a byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "emulator_models/soft_plc/cycle_recorder.hpp"
#include "emulator_models/soft_plc/event_ring.hpp"
#include "emulator_models/soft_plc/il_address.hpp"
#include "emulator_models/soft_plc/plc_observer.hpp"
#include "emulator_models/soft_plc/real_time_values.hpp"
#include "emulator_models/soft_plc/signal_recorder.hpp"

namespace emulator_models::soft_plc {

struct PlcRecorderConfig {
  /// Eight seconds of a cycle at 1 ms in which one signal changes each scan.
  static constexpr std::size_t ring_records_default = 8192;

  /// Bits of %I, %Q or %M, for each cycle the same list, at most SignalRecorder::signals_max.
  std::vector<DirectAddress> signals{};
  std::vector<DirectAddress> values{};  ///< of any size, likewise
  std::size_t ring_records = ring_records_default;
};

class PlcRecorder final : public PlcObserver {
 public:
  PlcRecorder(const PlcRecorderConfig& config, std::size_t cycles_count, std::chrono::nanoseconds power_up);

  void step_ordered(std::size_t cycle, const ScanTask& task, const CycleImage& image,
                    std::chrono::nanoseconds now) noexcept override;
  void program_failed(std::size_t cycle, SourcePlace place) noexcept override {
    cycles_[cycle]->recorder.program_failed_at(place);
  }
  void gateway_writes(std::size_t cycle, const GatewayItem& item) noexcept override;
  /// When no cycle runs any more: pushes what is summed up.
  void finish(std::chrono::nanoseconds now) noexcept;

  /// By number of the cycle; as long as the recorder lives.
  [[nodiscard]] std::vector<EventRing*> rings() noexcept;
  /// One word for each of the configured values, in their order; an address beyond the image reads as 0.
  [[nodiscard]] const RealTimeValues& values(std::size_t cycle) const noexcept {
    return cycles_[cycle]->values;
  }

 private:
  struct Cycle {
    Cycle(const PlcRecorderConfig& config, std::size_t number, std::chrono::nanoseconds power_up);

    EventRing ring;
    CycleRecorder recorder;
    SignalRecorder signals;
    RealTimeValues values;
    std::vector<std::byte> bits;  ///< the signals, gathered
    std::vector<std::uint64_t> published;
    ScanStamp scan{};      ///< latest seen
    bool is_open = false;  ///< that scan has not been seen to end
  };
  void end_scan(Cycle& cycle, const CycleImage& image) noexcept;

  const PlcRecorderConfig config_;
  const std::chrono::nanoseconds power_up_;
  std::vector<std::unique_ptr<Cycle>> cycles_;
};

}  // namespace emulator_models::soft_plc
