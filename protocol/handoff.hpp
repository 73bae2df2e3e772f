// Which of the two handoffs a segment has, the hardened one or the published one ("paper").
//
// Both call their memory NAME and divide it alike, so a side of one could open what the other has made. They are told apart
// by what lies beside it: NAME.roles is the first object that the hardened handoff makes, and the last one that it removes;
// the published one has none. Two sides of different handoffs that come at once are kept apart by RoleLock, not here.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "protocol/hardened/options.hpp"
#include "protocol/paper_options.hpp"

namespace protocol {

enum class Handoff : std::uint8_t { hardened, paper };

/// As programs are told it: "hardened", "paper".
[[nodiscard]] std::string_view name_of(Handoff handoff) noexcept;

/// A handoff, and how it is set up.
using HandoffOptions = std::variant<hardened::Options, PaperOptions>;

[[nodiscard]] Handoff kind_of(const HandoffOptions& options) noexcept;

/// Whose named objects are there; nothing if there are none of that name.
[[nodiscard]] std::optional<Handoff> handoff_of_segment(const std::string& segment_name) noexcept;

/// At the end of a kernel: removes the named objects if its emulator has ended before it. Otherwise that one does so, as it
/// always does in the published handoff.
void remove_if_unused(const std::string& segment_name, const HandoffOptions& options) noexcept;

}  // namespace protocol
