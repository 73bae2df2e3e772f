// The PLC's memory as text for the console: a screen that is drawn again, or a line for each change where the
// output is not a terminal.
//
// Takes copies of the memory and returns text; who calls it decides when, and where the text goes. Devices
// that change by themselves (clocks, calendar, scan times) are not reported as changes.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>

#include "emulator_models/device_labels.hpp"
#include "emulator_models/device_memory.hpp"

namespace emulator_models {

class PlcView {
 public:
  enum class Style : std::uint8_t { screen, lines };

  /// @param labels  must outlive this; a screen shows these devices, lines show any
  PlcView(Style style, const DeviceMemory& memory, std::span<const DeviceLabel> labels);

  /// @param memory   the memory now
  /// @param elapsed  time since the start
  /// @return         what to print; empty when nothing has changed
  [[nodiscard]] std::string update(const DeviceMemory& memory, std::chrono::nanoseconds elapsed);

 private:
  [[nodiscard]] std::string_view label_of(protocol::fx::Device device) const noexcept;
  [[nodiscard]] std::string screen(std::chrono::nanoseconds elapsed) const;

  static constexpr std::size_t shown_changes_max = 12;

  Style style_;
  DeviceMemory shown_;
  std::span<const DeviceLabel> labels_;
  bool nothing_shown_yet_ = true;
  std::deque<std::string> last_changes_;
};

}  // namespace emulator_models
