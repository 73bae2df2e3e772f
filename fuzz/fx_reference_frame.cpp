#include "fuzz/fx_reference_frame.hpp"

namespace fuzz {
namespace {

using protocol::fx::FrameError;

constexpr std::string_view hex_digits = "0123456789ABCDEF";
constexpr char stx = 0x02;
constexpr char etx = 0x03;
constexpr std::size_t longest_frame = 521;  // an E10 with 254 bytes
constexpr std::size_t envelope = 4;         // STX, ETX, two characters of the sum

unsigned sum_of(std::string_view command_to_etx) {
  unsigned sum = 0;
  for (const char c : command_to_etx) sum += static_cast<unsigned char>(c);
  return sum;
}

bool has_sum(std::string_view message) {
  const unsigned sum = sum_of(message.substr(1, message.size() - 3));
  const std::string_view digits = message.substr(message.size() - 2);
  return digits[0] == hex_digits[sum / 16 % 16] && digits[1] == hex_digits[sum % 16];
}

std::optional<FrameError> defect_of_envelope(std::string_view message) {
  if (message.size() < envelope || message.front() != stx || message[message.size() - 3] != etx)
    return FrameError::no_frame;
  if (message.size() > longest_frame) return FrameError::too_long;
  if (!has_sum(message)) return FrameError::bad_checksum;
  return std::nullopt;
}

std::string_view payload_of(std::string_view message) { return message.substr(1, message.size() - envelope); }

bool are_digits(std::string_view text) {
  return text.find_first_not_of(hex_digits) == std::string_view::npos;
}

ReferenceMessage damaged(FrameError defect) {
  ReferenceMessage message;
  message.defect = defect;
  return message;
}

/// @param text  what follows the letters of a read or write
ReferenceMessage read_or_write(std::string_view text, bool is_write, bool is_wide) {
  if (is_write ? text.size() < 6 || text.size() % 2 != 0 : text.size() != 6)
    return damaged(FrameError::bad_length);
  if (!are_digits(text)) return damaged(FrameError::bad_digit);
  const unsigned count = value_of(text.substr(4, 2));
  const std::string_view digits = text.substr(6);
  if (count < 1 || count > (is_wide ? 254U : 64U) || (is_write && digits.size() / 2 != count))
    return damaged(FrameError::bad_count);
  return {.defect = {},
          .kind = is_write ? ReferenceMessage::Kind::write : ReferenceMessage::Kind::read,
          .is_wide = is_wide,
          .is_on = false,
          .address = value_of(text.substr(0, 4)),
          .count_bytes = count,
          .digits = digits};
}

ReferenceMessage force(std::string_view text, bool is_on, bool is_wide) {
  if (text.size() != 4) return damaged(FrameError::bad_length);
  if (!are_digits(text)) return damaged(FrameError::bad_digit);
  return {.defect = {},
          .kind = ReferenceMessage::Kind::force,
          .is_wide = is_wide,
          .is_on = is_on,
          .address = value_of(text.substr(2, 2)) * 256 + value_of(text.substr(0, 2)),
          .count_bytes = 0,
          .digits = {}};
}

}  // namespace

std::string hexadecimal(unsigned value, unsigned digits_count) {
  std::string text(digits_count, '0');
  for (unsigned i = digits_count; i > 0; value /= 16) text[--i] = hex_digits[value % 16];
  return text;
}

unsigned value_of(std::string_view digits) {
  unsigned value = 0;
  for (const char digit : digits) value = 16 * value + static_cast<unsigned>(hex_digits.find(digit));
  return value;
}

std::string framed(std::string_view payload) {
  std::string frame{payload};
  frame += etx;
  return stx + frame + hexadecimal(sum_of(frame), 2);
}

ReferenceMessage reference_of_request(std::string_view message) {
  if (const auto defect = defect_of_envelope(message)) return damaged(*defect);
  const std::string_view payload = payload_of(message);
  if (payload.starts_with("0")) return read_or_write(payload.substr(1), false, false);
  if (payload.starts_with("1")) return read_or_write(payload.substr(1), true, false);
  if (payload.starts_with("7")) return force(payload.substr(1), true, false);
  if (payload.starts_with("8")) return force(payload.substr(1), false, false);
  if (payload.starts_with("E00")) return read_or_write(payload.substr(3), false, true);
  if (payload.starts_with("E10")) return read_or_write(payload.substr(3), true, true);
  if (payload.starts_with("E7")) return force(payload.substr(2), true, true);
  if (payload.starts_with("E8")) return force(payload.substr(2), false, true);
  return damaged(FrameError::unknown_command);
}

std::optional<FrameError> defect_of_reply(std::string_view message) {
  if (const auto defect = defect_of_envelope(message)) return defect;
  const std::string_view digits = payload_of(message);
  if (digits.size() % 2 != 0) return FrameError::bad_length;
  if (!are_digits(digits)) return FrameError::bad_digit;
  if (digits.empty() || digits.size() / 2 > 254) return FrameError::bad_count;
  return std::nullopt;
}

}  // namespace fuzz
