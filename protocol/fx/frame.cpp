#include "protocol/fx/frame.hpp"

#include <algorithm>
#include <optional>

namespace protocol::fx {
namespace {

/// Payload without its data: "0" aaaa nn, "E00" aaaa nn, "7" llhh, "E7" llhh.
struct CommandForm {
  Command command;
  std::string_view letters;
  bool is_force;
  bool carries_data;
  std::size_t data_bytes_max;
};

/// In the order of Command.
constexpr CommandForm forms[] = {
    {Command::read, "0", false, false, data_bytes_max_legacy},
    {Command::write, "1", false, true, data_bytes_max_legacy},
    {Command::force_on, "7", true, false, 0},
    {Command::force_off, "8", true, false, 0},
    {Command::read_wide, "E00", false, false, data_bytes_max_wide},
    {Command::write_wide, "E10", false, true, data_bytes_max_wide},
    {Command::force_on_wide, "E7", true, false, 0},
    {Command::force_off_wide, "E8", true, false, 0},
};

constexpr const CommandForm& form_of(Command command) noexcept {
  return forms[static_cast<std::size_t>(command)];
}

constexpr char to_char(std::byte byte) noexcept { return static_cast<char>(byte); }

constexpr std::byte hex_digit(unsigned nibble) noexcept {
  return static_cast<std::byte>("0123456789ABCDEF"[nibble & 0xFU]);
}

/// @return nothing for anything but 0-9 and A-F: lower case is not in the protocol's alphabet
constexpr std::optional<unsigned> hex_value(std::byte digit) noexcept {
  const char c = to_char(digit);
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10U;
  return std::nullopt;
}

bool all_hex(std::span<const std::byte> digits) noexcept {
  return std::all_of(digits.begin(), digits.end(), [](std::byte b) { return hex_value(b).has_value(); });
}

/// @param digits  hexadecimal digits, checked before, at most eight
unsigned number(std::span<const std::byte> digits) noexcept {
  unsigned value = 0;
  for (const std::byte digit : digits) value = value << 4U | hex_value(digit).value_or(0);
  return value;
}

/// @param digits  an even count of hexadecimal digits, checked before, for at most 254 bytes
DataBytes bytes_of(std::span<const std::byte> digits) noexcept {
  DataBytes bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(number(digits.subspan(i, 2))));
  return bytes;
}

void append_byte(FrameBytes& frame, unsigned byte) noexcept {
  frame.push_back(hex_digit(byte >> 4U));
  frame.push_back(hex_digit(byte));
}

unsigned sum_of(std::span<const std::byte> summed) noexcept {
  unsigned sum = 0;
  for (const std::byte byte : summed) sum += std::to_integer<unsigned>(byte);
  return sum & 0xFFU;
}

/// Ends a frame that holds STX and its payload.
void close_frame(FrameBytes& frame) noexcept {
  frame.push_back(etx);
  append_byte(frame, sum_of(as_span(frame).subspan(1)));
}

/// The checks that requests and replies share.
/// @return the payload, between STX and ETX
tl::expected<std::span<const std::byte>, FrameError> open_frame(std::span<const std::byte> frame) noexcept {
  constexpr std::size_t envelope_bytes = 4;  // STX, ETX, two sum characters
  if (frame.size() < envelope_bytes || frame.front() != stx || frame[frame.size() - 3] != etx)
    return tl::unexpected(FrameError::no_frame);
  if (frame.size() > frame_bytes_max) return tl::unexpected(FrameError::too_long);
  const std::span<const std::byte> sum = frame.last(2);
  if (!all_hex(sum) || number(sum) != sum_of(frame.subspan(1, frame.size() - 3)))
    return tl::unexpected(FrameError::bad_checksum);
  return frame.subspan(1, frame.size() - envelope_bytes);
}

const CommandForm* find_form(std::span<const std::byte> payload) noexcept {
  for (const CommandForm& form : forms) {
    if (payload.size() >= form.letters.size() &&
        std::equal(form.letters.begin(), form.letters.end(), payload.begin(),
                   [](char letter, std::byte byte) { return letter == to_char(byte); }))
      return &form;
  }
  return nullptr;
}

}  // namespace

std::string_view to_string(FrameError error) noexcept {
  switch (error) {
    case FrameError::no_frame:
      return "no frame";
    case FrameError::too_long:
      return "frame too long";
    case FrameError::bad_checksum:
      return "bad checksum";
    case FrameError::unknown_command:
      return "unknown command";
    case FrameError::bad_length:
      return "bad length";
    case FrameError::bad_digit:
      return "bad digit";
    case FrameError::bad_count:
      return "bad byte count";
  }
  return "unknown error";
}

FrameBytes encode(const Request& request) noexcept {
  const CommandForm& form = form_of(request.command);
  FrameBytes frame;
  frame.push_back(stx);
  for (const char letter : form.letters) frame.push_back(static_cast<std::byte>(letter));
  const unsigned high = request.address >> 8U;
  const unsigned low = request.address & 0xFFU;
  append_byte(frame, form.is_force ? low : high);  // force addresses travel low byte first
  append_byte(frame, form.is_force ? high : low);
  if (!form.is_force) append_byte(frame, request.count_bytes);
  for (const std::byte byte : request.data) append_byte(frame, std::to_integer<unsigned>(byte));
  close_frame(frame);
  return frame;
}

tl::expected<Request, FrameError> decode_request(std::span<const std::byte> frame) noexcept {
  const auto payload = open_frame(frame);
  if (!payload) return tl::unexpected(payload.error());
  const CommandForm* const form = find_form(*payload);
  if (form == nullptr) return tl::unexpected(FrameError::unknown_command);

  const std::span<const std::byte> body = payload->subspan(form->letters.size());
  const std::size_t fixed_digits = form->is_force ? 4 : 6;
  const bool length_fits =
      form->carries_data ? body.size() >= fixed_digits && body.size() % 2 == 0 : body.size() == fixed_digits;
  if (!length_fits) return tl::unexpected(FrameError::bad_length);
  if (!all_hex(body)) return tl::unexpected(FrameError::bad_digit);

  const unsigned first = number(body.first(2));
  const unsigned second = number(body.subspan(2, 2));
  Request request;
  request.command = form->command;
  request.address = static_cast<std::uint16_t>(form->is_force ? second << 8U | first : first << 8U | second);
  if (form->is_force) return request;

  request.count_bytes = static_cast<std::uint8_t>(number(body.subspan(4, 2)));
  const std::span<const std::byte> digits = body.subspan(fixed_digits);
  if (request.count_bytes == 0 || request.count_bytes > form->data_bytes_max ||
      (form->carries_data && digits.size() != 2U * request.count_bytes))
    return tl::unexpected(FrameError::bad_count);
  request.data = bytes_of(digits);
  return request;
}

FrameBytes encode_data_reply(std::span<const std::byte> data) noexcept {
  FrameBytes frame;
  frame.push_back(stx);
  for (const std::byte byte : data.first(std::min(data.size(), data_bytes_max_wide)))
    append_byte(frame, std::to_integer<unsigned>(byte));
  close_frame(frame);
  return frame;
}

tl::expected<DataBytes, FrameError> decode_data_reply(std::span<const std::byte> frame) noexcept {
  const auto digits = open_frame(frame);
  if (!digits) return tl::unexpected(digits.error());
  if (digits->size() % 2 != 0) return tl::unexpected(FrameError::bad_length);
  if (!all_hex(*digits)) return tl::unexpected(FrameError::bad_digit);
  if (digits->empty() || digits->size() > 2 * data_bytes_max_wide)
    return tl::unexpected(FrameError::bad_count);
  return bytes_of(*digits);
}

}  // namespace protocol::fx
