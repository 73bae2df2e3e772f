// The kernel's access to the signals of the PLC, for several threads at once.
//
// Behind it the port is used by whoever calls (DirectLink) or by one auxiliary thread alone (PolledLink).
// Every request is carried out once at most by the link; repetition after silence is the driver's business.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

#include <tl/expected.hpp>

#include "kernel_mocks/fx_driver.hpp"

namespace kernel_mocks {

class PlcLink {
 public:
  using Clock = std::chrono::steady_clock;
  using Device = protocol::fx::Device;
  using Done = tl::expected<void, FxDriverError>;

  /// M120 to M127.
  struct Status {
    std::byte signals{0};
    /// Not later than the PLC's image was read: the age of the status is at most now - read_at.
    Clock::time_point read_at;
  };

  virtual ~PlcLink() = default;

  /// The newest status there is.
  [[nodiscard]] virtual tl::expected<Status, FxDriverError> status() noexcept = 0;
  [[nodiscard]] virtual Done read_bytes(Device first, std::span<std::byte> into) noexcept = 0;
  [[nodiscard]] virtual Done write_bytes(Device first, std::span<const std::byte> bytes) noexcept = 0;
  [[nodiscard]] virtual Done force(Device device, bool on) noexcept = 0;

  [[nodiscard]] tl::expected<std::uint16_t, FxDriverError> read_word(Device word) noexcept;
  /// @param words  at most 32, written by one request
  [[nodiscard]] Done write_words(Device first, std::span<const std::uint16_t> words) noexcept;

 protected:
  PlcLink() = default;
  PlcLink(const PlcLink&) = default;
  PlcLink& operator=(const PlcLink&) = default;
};

/// Each call is an exchange of its own, made by the calling thread; calls of other threads wait for it.
class DirectLink final : public PlcLink {
 public:
  /// @param driver  connected; used by nobody else while the link lives
  explicit DirectLink(FxDriver& driver) noexcept : driver_{driver} {}

  tl::expected<Status, FxDriverError> status() noexcept override;
  Done read_bytes(Device first, std::span<std::byte> into) noexcept override;
  Done write_bytes(Device first, std::span<const std::byte> bytes) noexcept override;
  Done force(Device device, bool on) noexcept override;

 private:
  std::mutex mutex_;
  FxDriver& driver_;
};

}  // namespace kernel_mocks
