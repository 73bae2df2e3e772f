// Frames of the Mitsubishi FX programming port.
//
//   STX  command  data...  ETX  SUM-high  SUM-low
//
// SUM is the low byte of the sum of all bytes from the command to ETX, as two upper-case hexadecimal digits.
// ENQ, ACK and NAK are frames of one byte. README.md lists the choices
// made where the sources are silent.
//
// Decoding takes bytes and returns a value; nothing here reads a clock or a port.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <boost/container/static_vector.hpp>
#include <tl/expected.hpp>

namespace protocol::fx {

inline constexpr std::byte stx{0x02};
inline constexpr std::byte etx{0x03};
inline constexpr std::byte enq{0x05};
inline constexpr std::byte ack{0x06};
inline constexpr std::byte nak{0x15};

/// Longest data of a command 0 or 1 (40H), and of E00 or E10 (FEH).
inline constexpr std::size_t data_bytes_max_legacy = 64;
inline constexpr std::size_t data_bytes_max_wide = 254;
/// STX, "E10" + address + count, 254 bytes as digits, ETX, sum.
inline constexpr std::size_t frame_bytes_max = 1 + 9 + 2 * data_bytes_max_wide + 1 + 2;

using DataBytes = boost::container::static_vector<std::byte, data_bytes_max_wide>;
using FrameBytes = boost::container::static_vector<std::byte, frame_bytes_max>;

/// The bytes as a span. They do not convert by themselves: Boost's iterators do not claim to be contiguous.
[[nodiscard]] inline std::span<const std::byte> as_span(const DataBytes& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}
[[nodiscard]] inline std::span<const std::byte> as_span(const FrameBytes& bytes) noexcept {
  return {bytes.data(), bytes.size()};
}

enum class Command : std::uint8_t {
  read,            ///< "0"
  write,           ///< "1"
  force_on,        ///< "7"
  force_off,       ///< "8"
  read_wide,       ///< "E00"
  write_wide,      ///< "E10"
  force_on_wide,   ///< "E7"
  force_off_wide,  ///< "E8"
};

[[nodiscard]] constexpr bool is_wide(Command command) noexcept { return command >= Command::read_wide; }

struct Request {
  Command command = Command::read;
  /// Byte address (read, write) or bit number (force), as the address map in use defines it.
  std::uint16_t address = 0;
  /// read: bytes asked for; write: data.size(); force: 0.
  std::uint8_t count_bytes = 0;
  /// write: what to write, in ascending address order; otherwise empty.
  DataBytes data;

  bool operator==(const Request&) const = default;
};

/// What is wrong with a frame; in the order in which a frame is checked.
enum class FrameError : std::uint8_t {
  no_frame,         ///< does not begin with STX, or has no ETX followed by two characters at its end
  too_long,         ///< more than frame_bytes_max bytes
  bad_checksum,     ///< the sum does not match, or is not two upper-case hexadecimal digits
  unknown_command,  ///< a command this protocol has not, or that this codec leaves out (B, A, E01, E11, 4,
                    ///< ...)
  bad_length,       ///< too short or too long for its command
  bad_digit,        ///< an address, count or data character that is not 0-9 or A-F
  bad_count,        ///< zero, above the limit of the command, or not equal to the number of data bytes
};

[[nodiscard]] std::string_view to_string(FrameError error) noexcept;

/// The request as it stands, unchecked: what a PLC must refuse can be sent, too.
[[nodiscard]] FrameBytes encode(const Request& request) noexcept;
/// @param frame  one whole frame, STX to sum
/// @return       the request; or the first defect, in the order in which FrameError lists them
[[nodiscard]] tl::expected<Request, FrameError> decode_request(std::span<const std::byte> frame) noexcept;

/// The answer to a read: STX, the bytes as digits, ETX, sum.
/// @param data  1 to 254 bytes; what is beyond them is left out
[[nodiscard]] FrameBytes encode_data_reply(std::span<const std::byte> data) noexcept;
/// @return 1 to 254 bytes; or the first defect: every FrameError but unknown_command is possible
[[nodiscard]] tl::expected<DataBytes, FrameError> decode_data_reply(
    std::span<const std::byte> frame) noexcept;

/// Puts frames together from bytes that come one by one, as a serial line delivers them.
///
/// STX starts a frame anew at any time; ENQ drops what was begun. Bytes between frames are counted and
/// skipped. The caller brings the time: reset() after a silence longer than the character time-out.
class FrameReceiver {
 public:
  enum class Event : std::uint8_t {
    none,          ///< more bytes are needed
    enq_received,  ///< ENQ
    ack_received,  ///< ACK outside a frame
    nak_received,  ///< NAK outside a frame
    frame,         ///< frame() is complete, its sum not checked yet
    overlong,      ///< a frame exceeded frame_bytes_max and was dropped
  };

  Event receive(std::byte byte) noexcept;
  /// The frame that the last Event::frame announced, STX to sum; valid until the next receive().
  [[nodiscard]] std::span<const std::byte> frame() const noexcept;
  /// Drops a partial frame.
  /// @return whether there was one
  bool reset() noexcept;
  [[nodiscard]] bool in_frame() const noexcept;
  /// Bytes that came outside a frame and meant nothing, since construction.
  [[nodiscard]] std::size_t skipped_bytes_count() const noexcept;

 private:
  FrameBytes buffer_;
  std::size_t skipped_bytes_count_ = 0;
  std::uint8_t bytes_after_etx_ = 0;
  bool etx_seen_ = false;
  bool in_frame_ = false;
  bool complete_ = false;
};

}  // namespace protocol::fx
