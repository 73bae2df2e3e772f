#include "emulator_models/configuration_sender.hpp"

#include <algorithm>
#include <array>

#include "emulator_models/configuration_service.hpp"
#include "emulator_models/soft_plc/configuration_transfer.hpp"

namespace emulator_models {
namespace {

using protocol::fx::FrameReceiver;

/// What may come before the answer: a few late ones.
constexpr std::size_t noise_bytes_max = 16 * protocol::fx::frame_bytes_max;

std::string text_of(const TransferAnswer& answer) {
  std::string text;
  for (const std::byte byte : answer.text) text += static_cast<char>(byte);
  return text;
}

TransferRequest chunk_of(std::string_view text, std::size_t offset) {
  TransferRequest request{.command = TransferCommand::chunk,
                          .number = static_cast<std::uint32_t>(offset),
                          .second = 0,
                          .bytes = {}};
  for (const char character : text.substr(offset, chunk_bytes_max))
    request.bytes.push_back(static_cast<std::byte>(character));
  return request;
}

}  // namespace

tl::expected<void, ConfigurationSender::Failure> ConfigurationSender::send(std::string_view text) {
  auto sent = try_once(text);
  for (int tries = 1; tries < tries_max && !sent && !sent.error().is_refusal; ++tries) sent = try_once(text);
  return sent;
}

tl::expected<void, ConfigurationSender::Failure> ConfigurationSender::try_once(std::string_view text) {
  const std::uint32_t sum = soft_plc::crc32(text);
  const auto begun = exchange({.command = TransferCommand::begin,
                               .number = sum,
                               .second = static_cast<std::uint32_t>(text.size()),
                               .bytes = {}});
  if (!begun) return tl::unexpected{begun.error()};
  if (!begun->taken) return tl::unexpected{Failure{.is_refusal = true, .reason = text_of(*begun)}};
  for (std::size_t offset = 0; offset < text.size(); offset += chunk_bytes_max) {
    const auto sent = exchange(chunk_of(text, offset));
    if (!sent) return tl::unexpected{sent.error()};
    // Somebody else has begun a transfer, or a message came twice.
    if (!sent->taken) return tl::unexpected{Failure{.is_refusal = false, .reason = text_of(*sent)}};
  }
  const auto committed =
      exchange({.command = TransferCommand::commit, .number = sum, .second = 0, .bytes = {}});
  if (!committed) return tl::unexpected{committed.error()};
  if (!committed->taken)
    return tl::unexpected{Failure{.is_refusal = true, .reason = whole_reason(sum, *committed)}};
  return {};
}

std::string ConfigurationSender::whole_reason(std::uint32_t sum, const TransferAnswer& first) {
  std::string reason = text_of(first);
  std::size_t part_bytes = reason.size();
  while (part_bytes == reason_part_bytes_max && reason.size() < ConfigurationService::reason_bytes_max) {
    const auto next = exchange({.command = TransferCommand::reason,
                                .number = static_cast<std::uint32_t>(reason.size()),
                                .second = sum,
                                .bytes = {}});
    if (!next) return reason + std::string{ConfigurationService::cut_mark};
    part_bytes = next->text.size();
    reason += text_of(*next);
  }
  return reason;
}

tl::expected<TransferAnswer, ConfigurationSender::Failure> ConfigurationSender::exchange(
    const TransferRequest& request) {
  const auto failed = [](std::string reason) { return tl::unexpected{Failure{false, std::move(reason)}}; };
  port_.set_timeouts(
      {.read = request.command == TransferCommand::commit ? patience_.commit : patience_.message,
       .write = patience_.message});
  port_.purge();
  const protocol::fx::FrameBytes frame = encode(request);
  const auto written = port_.write(protocol::fx::as_span(frame));
  if (!written) return failed("the message cannot be sent: " + std::string{to_string(written.error())});
  if (*written != frame.size()) return failed("the message cannot be sent in time");
  FrameReceiver receiver;
  for (std::size_t received = 0; received < noise_bytes_max;) {
    std::array<std::byte, 256> bytes;
    const auto count = port_.read(bytes);
    if (!count) return failed("the answer cannot be read: " + std::string{to_string(count.error())});
    if (*count == 0) break;
    received += *count;
    for (std::size_t i = 0; i < *count; ++i) {
      const auto event = receiver.receive(bytes[i]);
      if (event == FrameReceiver::Event::nak_received)
        return failed(
            "refused as no message it knows: a PLC without --config, or a line that damages messages");
      if (event != FrameReceiver::Event::frame) continue;
      const auto answer = decode_transfer_answer(receiver.frame());
      // Another answer is a late one, of a request that was given up.
      if (answer && answer->command == request.command && answer->number == request.number) return *answer;
    }
  }
  return failed("no answer");
}

}  // namespace emulator_models
