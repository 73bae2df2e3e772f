#include "protocol/master_shared_memory_wrapper.hpp"

#include <thread>
#include <utility>

#include "protocol/deadline.hpp"

namespace protocol {

MasterSharedMemoryWrapper::MasterSharedMemoryWrapper(std::string segment_name, const PaperOptions& options,
                                                     ExchangeObserver* observer)
    : SharedMemoryWrapper(std::move(segment_name), options, observer, Side::master),
      read_timeout_(options.read_timeout) {
  last_request_.reserve(layout().request.capacity_bytes);
}

tl::expected<void, SharedMemoryError> MasterSharedMemoryWrapper::open() noexcept {
  return SharedMemoryWrapper::open();
}

void MasterSharedMemoryWrapper::close() noexcept { SharedMemoryWrapper::close(); }

bool MasterSharedMemoryWrapper::is_open() const noexcept { return SharedMemoryWrapper::is_open(); }

tl::expected<void, SharedMemoryError> MasterSharedMemoryWrapper::write(
    std::span<const std::byte> request) noexcept {
  if (!is_open()) return tl::unexpected(SharedMemoryError::not_open);
  if (request.size() > layout().request.capacity_bytes)
    return tl::unexpected(SharedMemoryError::request_too_long);
  // A request that is written before the answer to the last one was read has given that answer up.
  end_request(ExchangeOutcome::unknown);
  observer().submitted(request);
  request_is_open_ = true;
  last_request_.assign(request.begin(), request.end());
  if (send(request)) return {};
  // This is what the caller is told, and it may be wrong (hazard H5b).
  end_request(ExchangeOutcome::not_executed);
  return tl::unexpected(SharedMemoryError::semaphore_full);
}

bool MasterSharedMemoryWrapper::send(std::span<const std::byte> request) noexcept {
  write_area(layout().request, request);  // w1 w2
  publish_request();                      // w3
  observer().published();
  return release_semaphore();  // w4
}

tl::expected<std::size_t, SharedMemoryError> MasterSharedMemoryWrapper::get_response(
    std::span<std::byte> into) noexcept {
  if (!is_open()) return tl::unexpected(SharedMemoryError::not_open);
  const bool waits = options().read_wait == PaperOptions::ReadWait::poll;
  if (waits && !wait_for_response()) {  // r1
    end_request(ExchangeOutcome::unknown);
    return 0;
  }
  observer().accepted();
  const std::size_t length = read_area(layout().response, into);  // r2 r3
  if (waits && options().state_taken_back == PaperOptions::StateTakenBack::by_master)
    take_back_response();  // r4
  observer().delivered(into.first(length));
  end_request(ExchangeOutcome::ok);
  return length;
}

bool MasterSharedMemoryWrapper::wait_for_response() noexcept {
  if (poll_until_time_out()) return true;
  if (options().on_time_out != PaperOptions::OnTimeOut::send_again || !request_is_open_) return false;
  for (unsigned sent_again_count = 0; sent_again_count < options().send_again_count_max; ++sent_again_count) {
    send(last_request_);  // K4 = one may refuse the post: the request before it has not been taken either
    if (poll_until_time_out()) return true;
  }
  return false;
}

bool MasterSharedMemoryWrapper::poll_until_time_out() noexcept {
  const bool for_ever = options().on_time_out == PaperOptions::OnTimeOut::wait_for_ever;
  const auto deadline = deadline_after(read_timeout_);
  while (!response_is_published()) {
    if (!for_ever && std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(options().poll_interval);
  }
  return true;
}

void MasterSharedMemoryWrapper::end_request(ExchangeOutcome outcome) noexcept {
  if (!std::exchange(request_is_open_, false)) return;
  observer().ended(outcome);
}

void MasterSharedMemoryWrapper::set_timeouts(std::chrono::nanoseconds /*take*/,
                                             std::chrono::nanoseconds read) noexcept {
  read_timeout_ = read;
}

std::size_t MasterSharedMemoryWrapper::response_bytes_max() const noexcept {
  return layout().response.capacity_bytes;
}

}  // namespace protocol
