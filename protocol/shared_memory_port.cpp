#include "protocol/shared_memory_port.hpp"

#include <algorithm>
#include <utility>

#include "protocol/hardened/master.hpp"
#include "protocol/master_shared_memory_wrapper.hpp"

namespace protocol {

namespace {

PortError to_port_error(SharedMemoryError error) noexcept {
  switch (error) {
    case SharedMemoryError::not_open:
      return PortError::not_open;
    case SharedMemoryError::cannot_open:
    case SharedMemoryError::segment_too_small:
    case SharedMemoryError::not_made_in_time:
    case SharedMemoryError::other_layout:
    case SharedMemoryError::other_segment:
      return PortError::cannot_open;
    case SharedMemoryError::role_taken:
      return PortError::already_in_use;
    case SharedMemoryError::request_too_long:
      return PortError::message_too_long;
    case SharedMemoryError::semaphore_full:
      return PortError::refused;
    case SharedMemoryError::no_slave:
    case SharedMemoryError::slave_is_busy:
    case SharedMemoryError::rejected:
    case SharedMemoryError::not_executed:
      return PortError::not_executed;
    case SharedMemoryError::unanswered:
      return PortError::unanswered;
    case SharedMemoryError::slave_gone:
      return PortError::receiver_gone;
    case SharedMemoryError::damaged:
      return PortError::damaged;
  }
  return PortError::line_lost;
}

}  // namespace

SharedMemoryPort::SharedMemoryPort(std::string segment_name, const PaperOptions& options,
                                   ExchangeObserver* observer)
    : SharedMemoryPort(
          std::make_unique<MasterSharedMemoryWrapper>(std::move(segment_name), options, observer)) {}

SharedMemoryPort::SharedMemoryPort(std::string segment_name, const hardened::Options& options,
                                   ExchangeObserver* observer)
    : SharedMemoryPort(std::make_unique<hardened::Master>(std::move(segment_name), options, observer)) {}

SharedMemoryPort::SharedMemoryPort(std::unique_ptr<ExchangeMaster> master)
    : master_(std::move(master)), received_(master_->response_bytes_max()) {}

tl::expected<void, PortError> SharedMemoryPort::open() noexcept {
  return master_->open().map_error(to_port_error);
}

void SharedMemoryPort::close() noexcept {
  purge();
  master_->close();
}

bool SharedMemoryPort::is_open() const noexcept { return master_->is_open(); }

tl::expected<std::size_t, PortError> SharedMemoryPort::write(std::span<const std::byte> bytes) noexcept {
  if (!is_open()) return tl::unexpected(PortError::not_open);
  if (bytes.empty()) return 0;
  const auto written = master_->write(bytes);
  if (!written) return tl::unexpected(to_port_error(written.error()));
  return bytes.size();
}

tl::expected<std::size_t, PortError> SharedMemoryPort::read(std::span<std::byte> into) noexcept {
  if (!is_open()) return tl::unexpected(PortError::not_open);
  if (into.empty()) return 0;
  if (unread_.empty()) {
    const auto length = master_->get_response(received_);
    if (!length) return tl::unexpected(to_port_error(length.error()));
    unread_ = std::span(received_).first(*length);
  }
  const std::size_t count = std::min(into.size(), unread_.size());
  std::ranges::copy(unread_.first(count), into.begin());
  unread_ = unread_.subspan(count);
  return count;
}

void SharedMemoryPort::set_timeouts(const PortTimeouts& timeouts) noexcept {
  master_->set_timeouts(timeouts.write, timeouts.read);
}

void SharedMemoryPort::purge() noexcept { unread_ = {}; }

}  // namespace protocol
