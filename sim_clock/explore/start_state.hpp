// What puts the process under test into the same state before each execution.
#pragma once

#include <cstdint>
#include <string_view>

namespace ltsim {

enum class StartState : std::uint8_t {
  restore,  ///< what the simulator knows of is put back: it is fast, and libraries keep what they have come to
  fork,     ///< each execution has a process of its own, forked from one in which none has run
};

/// "restore", "fork": as on the command line and in schedules.
[[nodiscard]] constexpr std::string_view to_string(StartState state) noexcept {
  return state == StartState::restore ? "restore" : "fork";
}

}  // namespace ltsim
