// How instruction list sees the standard function blocks: their parameters as typed bytes of the instance.
//
// Instances lie in the variables of the program (function_blocks.hpp, as they are), so LD t.Q is a plain load. The
// timers and counters of a PLC (device_blocks.hpp) have their inputs there and their outputs in the PLC's memory.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "emulator_models/soft_plc/device_blocks.hpp"
#include "emulator_models/soft_plc/il_types.hpp"

namespace emulator_models::soft_plc {

enum class BlockKind : std::uint8_t {
  sr,
  rs,
  r_trig,
  f_trig,
  ctu,
  ctd,
  ctud,
  ton,
  tof,
  tp,
  device_timer,
  retentive_device_timer,
  device_counter,
  wide_device_counter,
};

/// Where a parameter lies: in the instance, or as a device in the PLC's memory.
enum class ParameterHome : std::uint8_t { instance, contact, value };

struct BlockParameter {
  std::string_view name;  ///< in capitals
  ElementaryType type;
  std::uint32_t offset;
  bool is_input;
  ParameterHome home = ParameterHome::instance;
};

inline constexpr std::size_t block_alignment = 8;

/// Of the standard blocks, which a program can declare.
[[nodiscard]] std::optional<BlockKind> block_kind(std::string_view upper_name) noexcept;
[[nodiscard]] std::string_view name_of(BlockKind kind) noexcept;
/// Inputs first, in the order of the standard.
[[nodiscard]] std::span<const BlockParameter> parameters_of(BlockKind kind) noexcept;
[[nodiscard]] const BlockParameter* parameter_of(BlockKind kind, std::string_view upper_name) noexcept;
/// IN, PT, CLK, CU, CD, R, PV, S1, S, R1: operators that store CR into the input of this name and call. LD is
/// none: it always loads.
[[nodiscard]] bool is_input_operator(std::string_view upper_operation) noexcept;

[[nodiscard]] std::size_t instance_bytes(BlockKind kind) noexcept;
/// @param instance  instance_bytes(kind) bytes, aligned to block_alignment
/// @param devices  of the blocks that have some
void construct(BlockKind kind, std::byte* instance, const BlockDevices& devices) noexcept;
/// @param memory  Area::memory, where the devices lie
void call(BlockKind kind, std::byte* instance, std::byte* memory, std::chrono::nanoseconds now) noexcept;

}  // namespace emulator_models::soft_plc
