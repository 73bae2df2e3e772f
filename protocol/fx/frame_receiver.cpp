#include "protocol/fx/frame.hpp"

namespace protocol::fx {

FrameReceiver::Event FrameReceiver::receive(std::byte byte) noexcept {
  if (complete_) reset();
  // None of STX and ENQ occurs inside a payload, so each is a safe place to start anew.
  if (byte == stx || byte == enq) {
    reset();
    if (byte == enq) return Event::enq_received;
    in_frame_ = true;
    buffer_.push_back(byte);
    return Event::none;
  }
  if (!in_frame_) {
    if (byte == ack) return Event::ack_received;
    if (byte == nak) return Event::nak_received;
    ++skipped_bytes_count_;
    return Event::none;
  }
  if (buffer_.size() == buffer_.capacity()) {
    reset();
    return Event::overlong;
  }
  buffer_.push_back(byte);
  if (etx_seen_) {
    if (++bytes_after_etx_ < 2) return Event::none;
    in_frame_ = false;
    complete_ = true;
    return Event::frame;
  }
  etx_seen_ = byte == etx;
  return Event::none;
}

std::span<const std::byte> FrameReceiver::frame() const noexcept {
  if (!complete_) return {};
  return {buffer_.data(), buffer_.size()};
}

bool FrameReceiver::reset() noexcept {
  const bool had_partial_frame = in_frame_;
  buffer_.clear();
  bytes_after_etx_ = 0;
  etx_seen_ = false;
  in_frame_ = false;
  complete_ = false;
  return had_partial_frame;
}

bool FrameReceiver::in_frame() const noexcept { return in_frame_; }

std::size_t FrameReceiver::skipped_bytes_count() const noexcept { return skipped_bytes_count_; }

}  // namespace protocol::fx
