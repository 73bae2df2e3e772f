// Why something cannot be done with the shared memory: of both variants of the handoff.
#pragma once

#include <cstdint>
#include <string_view>

namespace protocol {

enum class SharedMemoryError : std::uint8_t {
  not_open,           ///< it was never opened, or has been closed
  cannot_open,        ///< the system refused the segment or a semaphore
  segment_too_small,  ///< a segment of that name exists and has no room for the areas asked for
  request_too_long,   ///< more bytes than the request area holds
  semaphore_full,     ///< paper, K4 = one: the post before this one has not been consumed
  // The hardened variant only.
  role_taken,        ///< somebody else plays this side
  not_made_in_time,  ///< another process makes or opens the named objects, and does not finish
  other_layout,      ///< a segment of that name exists, for areas of another size
  other_segment,     ///< the other side is attached to a segment that lost its name
  no_slave,          ///< nobody serves: the request is not executed
  slave_is_busy,     ///< with a request that was given up: this one is not executed
  rejected,          ///< the slave answered that it does not execute the request
  not_executed,      ///< the request was withdrawn or dropped, and nobody has executed it or will
  // These three: the request may have been executed.
  unanswered,  ///< taken, and not answered in time: it may yet be executed
  slave_gone,  ///< the slave that had taken it has ended, or another one has come
  damaged,  ///< its answer cannot be read or has no room, or a state word that neither side writes was there
};

[[nodiscard]] std::string_view to_string(SharedMemoryError error) noexcept;

}  // namespace protocol
