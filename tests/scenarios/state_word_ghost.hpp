// What the state word would be if each of its changes were one step (I14).
//
// With K2 = halves a change is a load, a modification and a store. Whoever changes the word between the two
// has his change undone; then the word is not what it would be.
#pragma once

#include <cstdint>

#include "protocol/paper_options.hpp"
#include "protocol/shared_memory_wrapper.hpp"

namespace scenarios {

class StateWordGhost {
 public:
  explicit StateWordGhost(protocol::PaperOptions::StateCoding coding) noexcept
      : halves_(coding == protocol::PaperOptions::StateCoding::halves) {}

  void publish_request() noexcept { change(protocol::ExchangeState::request, 0, protocol::request_pending); }
  void publish_response() noexcept {
    change(protocol::ExchangeState::response, protocol::request_half, protocol::response_pending);
  }
  void take_back_response() noexcept { change(protocol::ExchangeState::idle, protocol::response_half, 0); }

  [[nodiscard]] std::uint32_t word() const noexcept { return word_; }
  [[nodiscard]] bool says_response() const noexcept {
    if (halves_) return (word_ & protocol::response_half) != 0;
    return word_ == static_cast<std::uint32_t>(protocol::ExchangeState::response);
  }

 private:
  void change(protocol::ExchangeState state, std::uint32_t cleared_bits, std::uint32_t set_bits) noexcept {
    word_ = halves_ ? (word_ & ~cleared_bits) | set_bits : static_cast<std::uint32_t>(state);
  }

  bool halves_;
  std::uint32_t word_ = 0;
};

}  // namespace scenarios
