// The emulator's side of the exchange: reads requests, writes responses.
//
//   wait_for_request   s1 wait for the semaphore
//   read_request       s2 request length    s3 request bytes
//                      s4 is the caller's: execute the request
//   write_response     s5 response length   s6 response bytes   s7 state := response
//                      s8 semaphore := 0 (K3 = reset only)
//
// The slave believes the semaphore: it does not look at the state word, so each token is a request to it,
// whatever the areas hold (hazards H5, H11).
//
// One thread calls these three in turn; request_stop() may come from any thread and from a signal handler.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "protocol/exchange_sides.hpp"
#include "protocol/shared_memory_wrapper.hpp"

namespace protocol {

class SlaveSharedMemoryWrapper final : public SharedMemoryWrapper, public ExchangeSlave {
 public:
  SlaveSharedMemoryWrapper(std::string segment_name, const PaperOptions& options,
                           ExchangeObserver* observer = nullptr);

  [[nodiscard]] tl::expected<void, SharedMemoryError> open() noexcept override;
  void close() noexcept override;

  /// Waits until the semaphore is released. A signal does not end the wait.
  /// @return false when a stop was requested; a request that is pending then is left as it is
  [[nodiscard]] bool wait_for_request() noexcept override;

  /// @return the bytes that the emulator is to execute, valid until the next read_request()
  [[nodiscard]] std::span<const std::byte> read_request() noexcept override;

  /// @param response  what exceeds the response area is cut off, as the published design sends no error
  void write_response(std::span<const std::byte> response) noexcept override;

  /// Lets wait_for_request() return false, now and for good. Async-signal-safe. Only the first call has an
  /// effect.
  void request_stop() noexcept override;

 private:
  std::vector<std::byte> request_;
  std::atomic<bool> stop_requested_ = false;
  bool stop_token_consumed_ = false;
};

static_assert(std::atomic<bool>::is_always_lock_free, "request_stop() may run in a signal handler");

}  // namespace protocol
