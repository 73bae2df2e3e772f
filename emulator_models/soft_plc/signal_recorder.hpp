// Changes of selected signals, as event records: compares the bits that were chosen with those of the scan before.
//
// The first call records nothing: there is no before. The cost of a call is proportional to the signals chosen, at
// most signals_max; each can push one record. One thread.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulator_models/soft_plc/event_ring.hpp"

namespace emulator_models::soft_plc {

class SignalRecorder {
 public:
  static constexpr std::size_t signals_max = 256;

  /// @param ring     outlives the recorder
  /// @param signals  bit numbers in the image, 8 x byte + bit; those beyond signals_max are ignored. The position in
  ///                 this list is the number of the signal in the records
  SignalRecorder(EventRing& ring, std::uint8_t cycle, std::span<const std::size_t> signals);

  /// @param image    a bit beyond its end counts as 0
  /// @param time_ns  since power-up
  void observe(std::span<const std::byte> image, std::uint64_t scan_number, std::int64_t time_ns) noexcept;

 private:
  EventRing& ring_;
  std::uint8_t cycle_;
  std::vector<std::size_t> signals_;
  std::bitset<signals_max> before_;
  bool has_before_ = false;
};

}  // namespace emulator_models::soft_plc
