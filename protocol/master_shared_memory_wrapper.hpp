// The kernel's side of the exchange: writes requests, reads responses.
//
//   write         w1 request length   w2 request bytes   w3 state := request   w4 release the semaphore
//   get_response  r1 wait until state = response         r2 response length    r3 response bytes
//                 r4 state := idle
//
// Nothing joins an answer to the request it belongs to: after a time-out the next answer that appears is
// taken for the answer to the next request (hazard H3).
//
// Not for two threads at once: the published design has no lock here (hazard H15).
#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "protocol/exchange_sides.hpp"
#include "protocol/shared_memory_wrapper.hpp"

namespace protocol {

class MasterSharedMemoryWrapper final : public SharedMemoryWrapper, public ExchangeMaster {
 public:
  MasterSharedMemoryWrapper(std::string segment_name, const PaperOptions& options,
                            ExchangeObserver* observer = nullptr);

  [[nodiscard]] tl::expected<void, SharedMemoryError> open() noexcept override;
  void close() noexcept override;
  [[nodiscard]] bool is_open() const noexcept override;

  /// Writes one request and wakes the slave. Does not look at the state word: a request that the slave has
  /// not taken yet is overwritten.
  /// @return request_too_long: nothing was done; semaphore_full (K4 = one): the request stands in the area
  /// and
  ///         in the state word, but the slave was not woken for it
  [[nodiscard]] tl::expected<void, SharedMemoryError> write(
      std::span<const std::byte> request) noexcept override;

  /// Waits for the response as K1 and K8 say, and copies it. What does not fit into `into` is lost.
  /// @return bytes copied; 0 after the time-out, and when the response is empty
  [[nodiscard]] tl::expected<std::size_t, SharedMemoryError> get_response(
      std::span<std::byte> into) noexcept override;

  /// K8: `read` in place of PaperOptions::read_timeout, from the next get_response() on. Zero: one look, no wait. The
  /// other has no meaning here: a write never waits.
  void set_timeouts(std::chrono::nanoseconds take, std::chrono::nanoseconds read) noexcept override;

  [[nodiscard]] std::size_t response_bytes_max() const noexcept override;

 private:
  bool send(std::span<const std::byte> request) noexcept;
  [[nodiscard]] bool wait_for_response() noexcept;
  [[nodiscard]] bool poll_until_time_out() noexcept;
  void end_request(ExchangeOutcome outcome) noexcept;

  std::chrono::nanoseconds read_timeout_;
  std::vector<std::byte> last_request_;  // for K8 = send_again
  bool request_is_open_ = false;
};

}  // namespace protocol
