// A serial port with the PLC right behind it: what is written is answered by the time write() returns.
#pragma once

#include <algorithm>
#include <span>

#include "emulator_models/i_plc_emulator.hpp"
#include "protocol/serial_port.hpp"

namespace scenarios {

class LocalPort final : public protocol::SerialPort {
 public:
  explicit LocalPort(emulator_models::IPlcEmulator& plc) noexcept : plc_{plc} {}

  tl::expected<void, protocol::PortError> open() noexcept override { return {}; }
  void close() noexcept override {}
  [[nodiscard]] bool is_open() const noexcept override { return true; }
  tl::expected<std::size_t, protocol::PortError> write(std::span<const std::byte> bytes) noexcept override {
    answer_ = plc_.process(bytes);
    read_count_ = 0;
    return bytes.size();
  }
  tl::expected<std::size_t, protocol::PortError> read(std::span<std::byte> into) noexcept override {
    const auto rest = protocol::fx::as_span(answer_).subspan(read_count_);
    const std::size_t count = std::min(rest.size(), into.size());
    std::copy_n(rest.begin(), count, into.begin());
    read_count_ += count;
    return count;
  }
  void set_timeouts(const protocol::PortTimeouts& /*timeouts*/) noexcept override {}
  void purge() noexcept override { read_count_ = answer_.size(); }

 private:
  emulator_models::IPlcEmulator& plc_;
  protocol::fx::FrameBytes answer_;
  std::size_t read_count_ = 0;
};

}  // namespace scenarios
