#include "emulator_models/configuration_frames.hpp"

#include <algorithm>

namespace emulator_models {
namespace {

using protocol::fx::DataBytes;
using protocol::fx::FrameBytes;

constexpr std::byte taken_mark{0xD0};
constexpr std::byte refused_mark{0xD1};
constexpr std::size_t number_bytes = 4;

bool has_second(TransferCommand command) noexcept {
  return command == TransferCommand::begin || command == TransferCommand::reason;
}

bool is_command(std::byte byte) noexcept { return byte >= std::byte{0xC0} && byte <= std::byte{0xC3}; }

void append_number(DataBytes& bytes, std::uint32_t number) noexcept {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(number >> shift));
}

void append_up_to(DataBytes& bytes, std::span<const std::byte> more, std::size_t count_max) noexcept {
  const auto count = static_cast<std::ptrdiff_t>(std::min(more.size(), count_max));
  bytes.insert(bytes.end(), more.begin(), more.begin() + count);
}

/// @param bytes  at least four
std::uint32_t number_of(std::span<const std::byte> bytes) noexcept {
  std::uint32_t number = 0;
  for (const std::byte byte : bytes.first(number_bytes))
    number = number << 8U | std::to_integer<std::uint32_t>(byte);
  return number;
}

FrameBytes framed(const DataBytes& bytes) noexcept {
  return protocol::fx::encode_data_reply(protocol::fx::as_span(bytes));
}

}  // namespace

FrameBytes encode(const TransferRequest& request) noexcept {
  DataBytes bytes;
  bytes.push_back(static_cast<std::byte>(request.command));
  append_number(bytes, request.number);
  if (has_second(request.command)) append_number(bytes, request.second);
  if (request.command == TransferCommand::chunk)
    append_up_to(bytes, protocol::fx::as_span(request.bytes), chunk_bytes_max);
  return framed(bytes);
}

FrameBytes encode(const TransferAnswer& answer) noexcept {
  DataBytes bytes;
  bytes.push_back(answer.taken ? taken_mark : refused_mark);
  bytes.push_back(static_cast<std::byte>(answer.command));
  append_number(bytes, answer.number);
  if (!answer.taken) append_up_to(bytes, protocol::fx::as_span(answer.text), reason_part_bytes_max);
  return framed(bytes);
}

std::optional<TransferRequest> decode_transfer_request(std::span<const std::byte> frame) noexcept {
  const auto decoded = protocol::fx::decode_data_reply(frame);
  if (!decoded || !is_command(decoded->front())) return std::nullopt;
  TransferRequest request;
  request.command = static_cast<TransferCommand>(decoded->front());
  std::span<const std::byte> rest = protocol::fx::as_span(*decoded).subspan(1);
  if (rest.size() < (has_second(request.command) ? 2 : 1) * number_bytes) return std::nullopt;
  request.number = number_of(rest);
  rest = rest.subspan(number_bytes);
  if (has_second(request.command)) {
    request.second = number_of(rest);
    rest = rest.subspan(number_bytes);
  }
  if (rest.empty() == (request.command == TransferCommand::chunk)) return std::nullopt;
  request.bytes.assign(rest.begin(), rest.end());
  return request;
}

std::optional<TransferAnswer> decode_transfer_answer(std::span<const std::byte> frame) noexcept {
  const auto decoded = protocol::fx::decode_data_reply(frame);
  if (!decoded || decoded->size() < 2 + number_bytes) return std::nullopt;
  const std::span<const std::byte> bytes = protocol::fx::as_span(*decoded);
  if ((bytes[0] != taken_mark && bytes[0] != refused_mark) || !is_command(bytes[1])) return std::nullopt;
  const std::span<const std::byte> text = bytes.subspan(2 + number_bytes);
  const bool taken = bytes[0] == taken_mark;
  if (taken && !text.empty()) return std::nullopt;
  return TransferAnswer{.taken = taken,
                        .command = static_cast<TransferCommand>(bytes[1]),
                        .number = number_of(bytes.subspan(2)),
                        .text = DataBytes(text.begin(), text.end())};
}

}  // namespace emulator_models
