// The two sides of an exchange over shared memory, as their users know them: the kernel's port and the loop of the
// emulator. Which handoff is behind them, the published one or the hardened one, is not their business.
#pragma once

#include <chrono>
#include <cstddef>
#include <span>

#include <tl/expected.hpp>

#include "protocol/shared_memory_error.hpp"

namespace protocol {

/// The kernel's side: one request, then its response.
class ExchangeMaster {
 public:
  virtual ~ExchangeMaster() = default;

  /// Opening an open side does nothing.
  [[nodiscard]] virtual tl::expected<void, SharedMemoryError> open() noexcept = 0;
  /// Closing twice does nothing.
  virtual void close() noexcept = 0;
  [[nodiscard]] virtual bool is_open() const noexcept = 0;

  /// Publishes one request and wakes the slave. A response that was not read before is given up.
  [[nodiscard]] virtual tl::expected<void, SharedMemoryError> write(
      std::span<const std::byte> request) noexcept = 0;
  /// Gets the response to the request written last.
  /// @param into  what does not fit is lost
  /// @return      bytes copied; 0 when the response is empty, or nothing was written. When none came in time: 0 in the
  ///              published handoff; how the request ended in the hardened one
  [[nodiscard]] virtual tl::expected<std::size_t, SharedMemoryError> get_response(
      std::span<std::byte> into) noexcept = 0;

  /// From the next write() on.
  /// @param take  until the slave has turned to a request; what does not wait for that has no use for it
  /// @param read  until the answer is there. Zero: one look
  virtual void set_timeouts(std::chrono::nanoseconds take, std::chrono::nanoseconds read) noexcept = 0;

  [[nodiscard]] virtual std::size_t response_bytes_max() const noexcept = 0;

 protected:
  ExchangeMaster() = default;
  ExchangeMaster(const ExchangeMaster&) = default;
  ExchangeMaster& operator=(const ExchangeMaster&) = default;
};

/// The emulator's side. One thread opens and closes; one thread, the same or another, calls the three steps in turn.
class ExchangeSlave {
 public:
  virtual ~ExchangeSlave() = default;

  /// Opening an open side does nothing.
  [[nodiscard]] virtual tl::expected<void, SharedMemoryError> open() noexcept = 0;
  /// Closing twice does nothing.
  virtual void close() noexcept = 0;

  /// @return false when a stop was requested
  [[nodiscard]] virtual bool wait_for_request() noexcept = 0;
  /// @return the bytes that the emulator is to execute, valid until the next wait_for_request()
  [[nodiscard]] virtual std::span<const std::byte> read_request() noexcept = 0;
  virtual void write_response(std::span<const std::byte> response) noexcept = 0;

  /// Lets wait_for_request() return false, now and for good. Of an open side, from any thread; async-signal-safe.
  virtual void request_stop() noexcept = 0;

 protected:
  ExchangeSlave() = default;
  ExchangeSlave(const ExchangeSlave&) = default;
  ExchangeSlave& operator=(const ExchangeSlave&) = default;
};

}  // namespace protocol
