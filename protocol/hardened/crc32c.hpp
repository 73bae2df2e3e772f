// CRC-32C (Castagnoli), as in RFC 3720: reflected, all ones before and after.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace protocol::hardened {

using Pieces = std::initializer_list<std::span<const std::byte>>;

/// Of the pieces, one after the other: by the processor's instruction where it has one, otherwise by the library.
[[nodiscard]] std::uint32_t crc32c(Pieces pieces) noexcept;

/// By CRC32, of SSE 4.2: eight bytes a step. The checksums of an exchange of 512 bytes cost more than all else of it when they
/// are made byte by byte (tests/bench/handoff_bench).
[[nodiscard]] std::uint32_t crc32c_by_instruction(Pieces pieces) noexcept;
[[nodiscard]] bool has_crc32c_instruction() noexcept;

[[nodiscard]] std::uint32_t crc32c_by_library(Pieces pieces) noexcept;

}  // namespace protocol::hardened
