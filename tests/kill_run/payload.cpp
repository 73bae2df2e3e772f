#include "tests/kill_run/payload.hpp"

#include <cstring>

#include "tests/kill_run/dice.hpp"

namespace kill_run {

namespace {

constexpr std::size_t number_bytes = sizeof(std::uint64_t);
constexpr std::size_t work_bytes = sizeof(std::uint32_t);

/// @param pattern  which of the patterns
Payload payload_of(std::uint64_t number, std::size_t header_bytes, std::uint64_t pattern) noexcept {
  Dice dice(number * 2 + pattern);
  Payload made(header_bytes + dice.below(payload_bytes_max - header_bytes + 1));
  for (std::byte& byte : made) byte = static_cast<std::byte>(dice.number());
  std::memcpy(made.data(), &number, number_bytes);
  return made;
}

}  // namespace

Payload request(std::uint64_t number, std::chrono::microseconds work) noexcept {
  Payload made = payload_of(number, number_bytes + work_bytes, 0);
  const auto work_us = static_cast<std::uint32_t>(work.count());
  std::memcpy(made.data() + number_bytes, &work_us, work_bytes);
  return made;
}

Payload answer_to(std::uint64_t number) noexcept { return payload_of(number, number_bytes, 1); }

std::uint64_t number_in(std::span<const std::byte> payload) noexcept {
  std::uint64_t number = 0;
  if (payload.size() >= number_bytes) std::memcpy(&number, payload.data(), number_bytes);
  return number;
}

std::chrono::microseconds work_in(std::span<const std::byte> request) noexcept {
  std::uint32_t work_us = 0;
  if (request.size() >= number_bytes + work_bytes)
    std::memcpy(&work_us, request.data() + number_bytes, work_bytes);
  return std::chrono::microseconds{work_us};
}

std::uint64_t digest(std::span<const std::byte> payload) noexcept {
  constexpr std::uint64_t prime = 0x0000'0100'0000'01B3U;
  std::uint64_t digest = 0xCBF2'9CE4'8422'2325U;
  digest = (digest ^ payload.size()) * prime;
  for (const std::byte byte : payload) digest = (digest ^ static_cast<std::uint64_t>(byte)) * prime;
  return digest;
}

}  // namespace kill_run
