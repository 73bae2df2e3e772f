#include "tests/kernel_mocks/scripted_port.hpp"

#include <algorithm>
#include <utility>

namespace kernel_mocks {

Bytes bytes_of(std::string_view text) {
  Bytes bytes;
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

ScriptedPort::Reply ScriptedPort::bytewise(std::string_view text) {
  Reply reply;
  for (const std::byte byte : bytes_of(text)) reply.pieces.push_back({byte});
  return reply;
}

tl::expected<void, protocol::PortError> ScriptedPort::open() noexcept {
  if (open_error) return tl::unexpected{*open_error};
  open_ = true;
  return {};
}

tl::expected<std::size_t, protocol::PortError> ScriptedPort::write(
    std::span<const std::byte> bytes) noexcept {
  if (write_error) return tl::unexpected{*write_error};
  written.emplace_back(bytes.begin(), bytes.end());
  if (!replies.empty()) {
    const Reply reply = std::move(replies.front());
    replies.pop_front();
    arrived_.insert(arrived_.end(), reply.pieces.begin(), reply.pieces.end());
    late_ = reply.late_pieces;
    error_ = reply.error;
  }
  return std::min(bytes.size(), write_bytes_max);
}

tl::expected<std::size_t, protocol::PortError> ScriptedPort::read(std::span<std::byte> into) noexcept {
  if (read_error) return tl::unexpected{*read_error};
  if (error_) return tl::unexpected{*std::exchange(error_, std::nullopt)};
  if (endless_noise) {
    into.front() = *endless_noise;
    return 1;
  }
  if (arrived_.empty()) {
    arrived_.assign(late_.begin(), late_.end());
    late_.clear();
    return 0;
  }
  Bytes& piece = arrived_.front();
  const std::size_t count = std::min(piece.size(), into.size());
  std::copy_n(piece.begin(), count, into.begin());
  piece.erase(piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(count));
  if (piece.empty()) arrived_.pop_front();
  return count;
}

void ScriptedPort::purge() noexcept {
  ++purges;
  arrived_.clear();
}

}  // namespace kernel_mocks
