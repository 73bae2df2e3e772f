#include "kernel_mocks/fx_driver.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <thread>

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

using protocol::fx::AddressSpace;
using protocol::fx::Command;
using protocol::fx::Device;

struct Place {
  std::uint16_t address = 0;
  AddressSpace space = AddressSpace::legacy;
};

/// Legacy commands wherever they reach: every FX knows them.
template <typename Lookup>
std::optional<Place> place_of(Device device, protocol::fx::Model model, Lookup lookup) noexcept {
  for (const AddressSpace space : {AddressSpace::legacy, AddressSpace::wide}) {
    if (const auto address = lookup(device, model, space)) return Place{*address, space};
  }
  return std::nullopt;
}

std::size_t bytes_max(AddressSpace space) noexcept {
  return space == AddressSpace::legacy ? protocol::fx::data_bytes_max_legacy
                                       : protocol::fx::data_bytes_max_wide;
}

bool is_read(Command command) noexcept { return command == Command::read || command == Command::read_wide; }

}  // namespace

std::string_view to_string(FxDriverError error) noexcept {
  switch (error) {
    case FxDriverError::not_reachable:
      return "the PLC model has no such device";
    case FxDriverError::bad_length:
      return "more bytes than one request carries";
    case FxDriverError::port_failed:
      return "the port failed";
    case FxDriverError::write_timed_out:
      return "the port did not take the request in time";
    case FxDriverError::no_answer:
      return "the PLC does not answer";
    case FxDriverError::truncated_answer:
      return "the answer of the PLC was cut off";
    case FxDriverError::nak:
      return "the PLC refused the request (NAK)";
    case FxDriverError::bad_frame:
      return "the answer of the PLC is not a frame";
    case FxDriverError::bad_checksum:
      return "the answer of the PLC has a wrong sum";
    case FxDriverError::wrong_length:
      return "the answer of the PLC has a wrong length";
    case FxDriverError::unexpected_answer:
      return "the answer of the PLC is of another kind than the request wants";
    case FxDriverError::surplus_bytes:
      return "more than one answer came to one request";
    case FxDriverError::not_executed:
      return "the PLC did not take the request, which was not executed";
    case FxDriverError::outcome_unknown:
      return "nobody knows whether the PLC has executed a request";
  }
  return "unknown error";
}

std::string to_string(const RequestInDoubt& in_doubt) {
  const std::string device = protocol::fx::to_string(in_doubt.device);
  const std::string_view reason = to_string(in_doubt.reason);
  switch (in_doubt.command) {
    case Command::force_on:
    case Command::force_on_wide:
      return fmt::format("force {} on: {}", device, reason);
    case Command::force_off:
    case Command::force_off_wide:
      return fmt::format("force {} off: {}", device, reason);
    default:
      return fmt::format("write {} {} from {} on: {}", in_doubt.count_bytes,
                         in_doubt.count_bytes == 1 ? "byte" : "bytes", device, reason);
  }
}

FxDriver::FxDriver(protocol::SerialPort& port, const FxDriverOptions& options)
    : port_{port}, options_{options} {}

tl::expected<void, FxDriverError> FxDriver::connect() noexcept {
  if (!port_.is_open()) {
    if (const auto opened = port_.open(); !opened) return failed(opened.error());
  }
  port_.set_timeouts({.read = options_.answer_timeout, .write = options_.send_timeout});
  line_is_clean_ = false;
  ++counters_.requests;
  constexpr std::array frame{protocol::fx::enq};
  FxDriverError last = FxDriverError::no_answer;
  for (unsigned attempt = 0; attempt < options_.enq_tries; ++attempt) {
    if (attempt > 0) repeat(last);
    const auto answered = try_once(frame, {});
    if (answered) return {};
    // ENQ changes nothing.
    last = answered.error() == FxDriverError::outcome_unknown ? FxDriverError::no_answer : answered.error();
    if (last == FxDriverError::port_failed) break;
  }
  return tl::unexpected{last};
}

tl::expected<void, FxDriverError> FxDriver::read_bytes(Device first, std::span<std::byte> into) noexcept {
  const auto place = place_of(first, options_.model, protocol::fx::byte_address);
  if (!place) return tl::unexpected{FxDriverError::not_reachable};
  if (into.empty() || into.size() > bytes_max(place->space)) return tl::unexpected{FxDriverError::bad_length};
  return request(first,
                 {.command = place->space == AddressSpace::wide ? Command::read_wide : Command::read,
                  .address = place->address,
                  .count_bytes = static_cast<std::uint8_t>(into.size()),
                  .data = {}},
                 into);
}

tl::expected<void, FxDriverError> FxDriver::write_bytes(Device first,
                                                        std::span<const std::byte> bytes) noexcept {
  const auto place = place_of(first, options_.model, protocol::fx::byte_address);
  if (!place) return tl::unexpected{FxDriverError::not_reachable};
  if (bytes.empty() || bytes.size() > bytes_max(place->space)) {
    return tl::unexpected{FxDriverError::bad_length};
  }
  return request(first,
                 {.command = place->space == AddressSpace::wide ? Command::write_wide : Command::write,
                  .address = place->address,
                  .count_bytes = static_cast<std::uint8_t>(bytes.size()),
                  .data = protocol::fx::DataBytes(bytes.begin(), bytes.end())},
                 {});
}

tl::expected<void, FxDriverError> FxDriver::force(Device device, bool on) noexcept {
  const auto place = place_of(device, options_.model, protocol::fx::bit_number);
  if (!place) return tl::unexpected{FxDriverError::not_reachable};
  const bool wide = place->space == AddressSpace::wide;
  const Command command = on ? (wide ? Command::force_on_wide : Command::force_on)
                             : (wide ? Command::force_off_wide : Command::force_off);
  return request(device, {.command = command, .address = place->address, .count_bytes = 0, .data = {}}, {});
}

tl::expected<std::uint16_t, FxDriverError> FxDriver::read_word(Device word) noexcept {
  std::array<std::byte, 2> bytes{};
  if (const auto done = read_bytes(word, bytes); !done) return tl::unexpected{done.error()};
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[0]) | std::to_integer<unsigned>(bytes[1])
                                                                              << 8U);
}

tl::expected<void, FxDriverError> FxDriver::write_words(Device first,
                                                        std::span<const std::uint16_t> words) noexcept {
  std::array<std::byte, protocol::fx::data_bytes_max_wide> bytes{};
  if (words.size() * 2 > bytes.size()) return tl::unexpected{FxDriverError::bad_length};
  for (std::size_t index = 0; index < words.size(); ++index) {
    bytes[2 * index] = static_cast<std::byte>(words[index] & 0xFFU);
    bytes[2 * index + 1] = static_cast<std::byte>(words[index] >> 8U);
  }
  return write_bytes(first, std::span{bytes}.first(words.size() * 2));
}

tl::expected<void, FxDriverError> FxDriver::request(Device device, const protocol::fx::Request& request,
                                                    std::span<std::byte> answer) noexcept {
  ++counters_.requests;
  const protocol::fx::FrameBytes frame = encode(request);
  FxDriverError last = FxDriverError::no_answer;
  for (unsigned attempt = 0;; ++attempt) {
    if (attempt > 0) repeat(last);
    auto done = try_once({frame.data(), frame.size()}, answer);
    if (done) return {};
    if (done.error() == FxDriverError::outcome_unknown) {
      if (!is_read(request.command)) {
        if (!request_in_doubt_)
          request_in_doubt_ = {request.command, device, request.count_bytes, last_port_error_};
        return done;
      }
      done = tl::unexpected{FxDriverError::no_answer};
    }
    // A port that failed is beyond what sending again can mend.
    if (done.error() == FxDriverError::port_failed || attempt == options_.retries) return done;
    last = done.error();
  }
}

/// That nobody serves is known at once. Whoever is being started has the time that one who is busy would have had.
void FxDriver::repeat(FxDriverError after) noexcept {
  ++counters_.retries;
  if (after == FxDriverError::not_executed) std::this_thread::sleep_until(sent_at_ + options_.send_timeout);
}

tl::expected<void, FxDriverError> FxDriver::try_once(std::span<const std::byte> frame,
                                                     std::span<std::byte> answer) noexcept {
  if (!line_is_clean_) port_.purge();
  line_is_clean_ = false;
  sent_at_ = std::chrono::steady_clock::now();
  if (const auto sent = send(frame); !sent) return sent;
  const auto wait = frame.size() == 1 ? options_.enq_wait : options_.request_wait;
  if (wait > std::chrono::nanoseconds{0}) std::this_thread::sleep_for(wait);
  const auto event = receive();
  if (!event) return tl::unexpected{event.error()};
  switch (*event) {
    case Event::ack_received:
      if (!answer.empty()) return tl::unexpected{FxDriverError::unexpected_answer};
      break;
    case Event::frame:
      if (answer.empty()) return tl::unexpected{FxDriverError::unexpected_answer};
      if (const auto taken = take_data(answer); !taken) return taken;
      break;
    case Event::nak_received:
      return tl::unexpected{FxDriverError::nak};
    case Event::overlong:
      return tl::unexpected{FxDriverError::bad_frame};
    case Event::enq_received:
    case Event::none:
      return tl::unexpected{FxDriverError::unexpected_answer};
  }
  line_is_clean_ = true;
  return {};
}

tl::expected<void, FxDriverError> FxDriver::send(std::span<const std::byte> frame) noexcept {
  const auto written = port_.write(frame);
  if (!written) return failed(written.error());
  if (*written != frame.size()) {
    ++counters_.time_outs;
    return tl::unexpected{FxDriverError::write_timed_out};
  }
  return {};
}

tl::expected<FxDriver::Event, FxDriverError> FxDriver::receive() noexcept {
  // A byte stream that never makes an answer must not hold the caller longer than silence would.
  const auto deadline = std::chrono::steady_clock::now() + options_.answer_timeout;
  std::array<std::byte, protocol::fx::frame_bytes_max> buffer{};
  receiver_.reset();
  do {
    const auto count = port_.read(buffer);
    if (!count) return failed(count.error());
    if (*count == 0) break;
    for (std::size_t index = 0; index < *count; ++index) {
      const Event event = receiver_.receive(buffer[index]);
      if (event == Event::none) continue;
      // What follows a frame that was dropped as too long is the rest of it.
      if (event != Event::overlong && index + 1 != *count)
        return tl::unexpected{FxDriverError::surplus_bytes};
      return event;
    }
  } while (std::chrono::steady_clock::now() < deadline);
  ++counters_.time_outs;
  return tl::unexpected{receiver_.in_frame() ? FxDriverError::truncated_answer : FxDriverError::no_answer};
}

tl::expected<void, FxDriverError> FxDriver::take_data(std::span<std::byte> answer) const noexcept {
  const auto data = protocol::fx::decode_data_reply(receiver_.frame());
  if (!data) {
    return tl::unexpected{data.error() == protocol::fx::FrameError::bad_checksum ? FxDriverError::bad_checksum
                                                                                 : FxDriverError::bad_frame};
  }
  if (data->size() != answer.size()) return tl::unexpected{FxDriverError::wrong_length};
  std::ranges::copy(*data, answer.begin());
  return {};
}

tl::unexpected<FxDriverError> FxDriver::failed(protocol::PortError error) noexcept {
  last_port_error_ = error;
  const bool in_doubt = is_in_doubt(error);
  if (!in_doubt && error != protocol::PortError::not_executed)
    return tl::unexpected{FxDriverError::port_failed};
  ++counters_.time_outs;
  return tl::unexpected{in_doubt ? FxDriverError::outcome_unknown : FxDriverError::not_executed};
}

}  // namespace kernel_mocks
