// What is sent: bytes that say which request they belong to, and that differ from those of any other request in every
// place, so that mixed bytes are noticed.
//
//   request   number 8 | work_us 4 | pattern     12 to 512 bytes
//   answer    number 8 | pattern                  8 to 512 bytes, of another length than its request
//
// Host order. Lengths and patterns follow from the number alone.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/fx/frame.hpp"

namespace kill_run {

/// What the emulator's loop carries.
using Payload = protocol::fx::FrameBytes;

inline constexpr std::size_t payload_bytes_max = 512;
static_assert(payload_bytes_max <= protocol::fx::frame_bytes_max);

/// @param number  from 1
/// @param work    how long its execution is to last; under an hour
[[nodiscard]] Payload request(std::uint64_t number, std::chrono::microseconds work) noexcept;
[[nodiscard]] Payload answer_to(std::uint64_t number) noexcept;

/// @return the number of the request or the answer; 0: the bytes are too short for one
[[nodiscard]] std::uint64_t number_in(std::span<const std::byte> payload) noexcept;
/// @return how long the request's execution is to last; zero when the bytes are too short to say so
[[nodiscard]] std::chrono::microseconds work_in(std::span<const std::byte> request) noexcept;

/// FNV-1a over the length and the bytes: a journal has no room for the bytes themselves.
[[nodiscard]] std::uint64_t digest(std::span<const std::byte> payload) noexcept;

}  // namespace kill_run
