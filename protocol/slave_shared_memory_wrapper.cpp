#include "protocol/slave_shared_memory_wrapper.hpp"

#include <algorithm>
#include <utility>

namespace protocol {

SlaveSharedMemoryWrapper::SlaveSharedMemoryWrapper(std::string segment_name, const PaperOptions& options,
                                                   ExchangeObserver* observer)
    : SharedMemoryWrapper(std::move(segment_name), options, observer, Side::slave),
      request_(layout().size_bytes - layout().request.bytes_offset) {}

tl::expected<void, SharedMemoryError> SlaveSharedMemoryWrapper::open() noexcept {
  return SharedMemoryWrapper::open();
}

void SlaveSharedMemoryWrapper::close() noexcept { SharedMemoryWrapper::close(); }

bool SlaveSharedMemoryWrapper::wait_for_request() noexcept {
  while (!stop_requested_.load()) {
    if (!wait_for_semaphore()) continue;  // s1
    if (stop_requested_.load()) {
      stop_token_consumed_ = true;
      return false;
    }
    observer().taken();
    return true;
  }
  // Leaves the count as if there had been no stop.
  if (!std::exchange(stop_token_consumed_, true)) try_consume_semaphore();
  return false;
}

std::span<const std::byte> SlaveSharedMemoryWrapper::read_request() noexcept {
  const std::size_t length = read_area(layout().request, request_);  // s2 s3
  const std::span<const std::byte> request = std::span(request_).first(length);
  observer().executed(request);
  return request;
}

void SlaveSharedMemoryWrapper::write_response(std::span<const std::byte> response) noexcept {
  const auto sent = response.first(std::min(response.size(), layout().response.capacity_bytes));
  write_area(layout().response, sent);  // s5 s6
  observer().answered(sent);
  publish_response();  // s7
  observer().announced();
  if (options().semaphore_after_answer == PaperOptions::SemaphoreAfterAnswer::reset)
    while (try_consume_semaphore()) {  // s8
    }
}

void SlaveSharedMemoryWrapper::request_stop() noexcept {
  if (stop_requested_.exchange(true)) return;
  if (is_open()) post_semaphore();
}

}  // namespace protocol
