// How a monitor ends an execution in which an invariant is broken, and what its messages are made of.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "protocol/exchange_observer.hpp"
#include "sim_clock/world/world.hpp"

namespace scenarios {

class Verdict {
 public:
  /// @param only  the invariant to judge by, "I4"; empty: all
  Verdict(ltsim::World& world, std::string_view only) : world_(world), only_(only) {}

  /// Returns if the invariants are not what is judged by; the execution goes on then.
  /// @param invariants  that are broken; empty ones do not count
  /// @param text        makes the rest of the message; called only if the monitor judges by one of them
  template <typename Text>
  void violated(std::initializer_list<std::string_view> invariants, const Text& text) const {
    if (!only_.empty() && std::ranges::find(invariants, only_) == invariants.end()) return;
    std::string message{only_};
    if (message.empty()) {
      for (const std::string_view invariant : invariants) {
        if (invariant.empty()) continue;
        if (!message.empty()) message += ", ";
        message += invariant;
      }
    }
    message.append(": ").append(text());
    const ltsim::GhostScope ghost;
    world_.violated(std::move(message));
  }

 private:
  ltsim::World& world_;
  std::string_view only_;
};

[[nodiscard]] inline std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes)
    text += fmt::format("{}{:02x}", text.empty() ? "" : " ", std::to_integer<unsigned>(byte));
  return text.empty() ? "nothing" : text;
}

}  // namespace scenarios
