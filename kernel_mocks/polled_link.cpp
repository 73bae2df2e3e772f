#include "kernel_mocks/polled_link.hpp"

#include <algorithm>
#include <array>

#include "kernel_mocks/plc_signals.hpp"

namespace kernel_mocks {

PolledLink::PolledLink(FxDriver& driver, const PolledLinkOptions& options)
    : driver_{driver}, options_{options}, thread_{[this] { run(); }} {}

PolledLink::~PolledLink() {
  {
    const std::scoped_lock lock{mutex_};
    stopping_ = true;
  }
  work_.notify_all();
  thread_.join();
}

tl::expected<PlcLink::Status, FxDriverError> PolledLink::status() noexcept {
  std::unique_lock lock{mutex_};
  finished_.wait_for(lock, options_.call_timeout, [this] { return polled_; });
  return last_;
}

PlcLink::Done PolledLink::read_bytes(Device first, std::span<std::byte> into) noexcept {
  const auto request =
      std::make_shared<Request>(Request{Kind::read, first, false, std::vector<std::byte>(into.size())});
  auto done = carry_out(request);
  if (done) std::ranges::copy(request->bytes, into.begin());
  return done;
}

PlcLink::Done PolledLink::write_bytes(Device first, std::span<const std::byte> bytes) noexcept {
  return carry_out(
      std::make_shared<Request>(Request{Kind::write, first, false, {bytes.begin(), bytes.end()}}));
}

PlcLink::Done PolledLink::force(Device device, bool on) noexcept {
  return carry_out(std::make_shared<Request>(Request{Kind::force, device, on, {}}));
}

PlcLink::Done PolledLink::carry_out(const std::shared_ptr<Request>& request) noexcept {
  std::unique_lock lock{mutex_};
  queue_.push_back(request);
  work_.notify_one();
  if (finished_.wait_for(lock, options_.call_timeout, [&] { return request->done; })) return request->result;
  if (!request->begun) std::erase(queue_, request);
  return tl::unexpected{FxDriverError::write_timed_out};
}

void PolledLink::run() noexcept {
  auto next_poll = Clock::now();
  std::unique_lock lock{mutex_};
  while (!stopping_) {
    if (!queue_.empty()) {
      const auto request = queue_.front();
      queue_.pop_front();
      request->begun = true;
      lock.unlock();
      execute(*request);
      lock.lock();
      request->done = true;
      finished_.notify_all();
    }
    if (Clock::now() >= next_poll && !stopping_) {
      lock.unlock();
      const auto read_at = Clock::now();
      std::array<std::byte, 1> byte{};
      const auto done = driver_.read_bytes(signals::status_byte, byte);
      lock.lock();
      if (done) {
        last_ = Status{byte.front(), read_at};
      } else {
        last_ = tl::unexpected{done.error()};
      }
      polled_ = true;
      finished_.notify_all();
      next_poll = Clock::now() + options_.poll_interval;
    }
    work_.wait_until(lock, next_poll, [this] { return stopping_ || !queue_.empty(); });
  }
  for (const auto& request : queue_) {
    request->done = true;
    request->result = tl::unexpected{FxDriverError::write_timed_out};
  }
  queue_.clear();
  finished_.notify_all();
}

// The caller does not look at the request before it is done, nor after it has given it up.
void PolledLink::execute(Request& request) noexcept {
  switch (request.kind) {
    case Kind::read:
      request.result = driver_.read_bytes(request.device, request.bytes);
      break;
    case Kind::write:
      request.result = driver_.write_bytes(request.device, request.bytes);
      break;
    case Kind::force:
      request.result = driver_.force(request.device, request.on);
      break;
  }
}

}  // namespace kernel_mocks
