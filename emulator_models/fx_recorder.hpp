// Records an FxPlc: what it does, what the programming port writes, and how chosen bits change, as event records in a
// ring; and the values of chosen devices after each scan, for any thread.
//
//   plc.observe_with(&recorder)   the thread that scans
//   recorder.ring()               who stores: archive/plc_archive.hpp
//   recorder.values().read()      anybody
//
// A write of the port is recorded when the PLC has acknowledged it. Its area is a PortArea, its address as on the wire.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "emulator_models/fx_plc_observer.hpp"
#include "emulator_models/soft_plc/cycle_recorder.hpp"
#include "emulator_models/soft_plc/event_ring.hpp"
#include "emulator_models/soft_plc/real_time_values.hpp"
#include "emulator_models/soft_plc/signal_recorder.hpp"

namespace emulator_models {

struct FxRecorderConfig {
  /// A minute of an FX that changes 100 signals a second.
  static constexpr std::size_t ring_records_default = 8192;

  std::vector<protocol::fx::Device>
      signals{};  ///< bit devices of the model, at most SignalRecorder::signals_max
  std::vector<protocol::fx::Device> values{};  ///< any devices of the model
  std::size_t ring_records = ring_records_default;
};

/// Code of a port_write record: how its address counts.
enum class PortArea : std::uint16_t { bytes, bytes_wide, bits, bits_wide };

class FxRecorder final : public FxPlcObserver {
 public:
  /// @param power_up  from which the times of the records count
  FxRecorder(const FxRecorderConfig& config, protocol::fx::Model model, SteadyTime power_up);

  void step_ordered(const FxPlc& plc, const DeviceMemory* memory, SteadyTime now) noexcept override;
  void request_served(std::span<const std::byte> request,
                      const protocol::fx::FrameBytes& answer) noexcept override;
  /// When nobody scans any more: pushes what is summed up.
  void finish(SteadyTime now) noexcept { cycle_.finish(now.time_since_epoch()); }

  [[nodiscard]] soft_plc::EventRing& ring() noexcept { return ring_; }
  /// One word for each of the configured values, in their order.
  [[nodiscard]] const soft_plc::RealTimeValues& values() const noexcept { return values_; }

 private:
  soft_plc::EventRing ring_;
  soft_plc::CycleRecorder cycle_;
  soft_plc::SignalRecorder signals_;
  soft_plc::RealTimeValues values_;
  std::vector<protocol::fx::Device> devices_;
  std::vector<std::uint64_t> published_;
  SteadyTime power_up_;
  soft_plc::ScanStamp scan_;  ///< under way
};

}  // namespace emulator_models
