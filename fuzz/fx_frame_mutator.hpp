// New inputs of given ones where the bytes hold frames of the programming port: what changes between STX and ETX gets a new
// sum, which is the right one nearly always.
//
// Addresses and counts are drawn from the edges of the protocol's tables as often as at random: one in 65,536 addresses is
// the last byte of an area.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "sim_clock/scenario/fuzz_target.hpp"

namespace fuzz {

/// The input is one frame.
[[nodiscard]] std::size_t mutate_frame(std::span<std::byte> data, std::size_t size, unsigned seed,
                                       ltsim::PlainMutator plain);
/// The input is a stream: frames, and other bytes before, between and in them.
[[nodiscard]] std::size_t mutate_stream(std::span<std::byte> data, std::size_t size, unsigned seed,
                                        ltsim::PlainMutator plain);
/// The input consists of lines: frames, and events in words.
/// @param events  lines without their '\n'
[[nodiscard]] std::size_t mutate_lines(std::span<std::byte> data, std::size_t size, unsigned seed,
                                       ltsim::PlainMutator plain, std::span<const std::string_view> events);

/// Cut before each STX, ENQ and byte that no line of 7 bits brings.
[[nodiscard]] std::vector<std::string_view> frames_as_records(std::string_view input);

}  // namespace fuzz
