#include "protocol/hardened/crc32c.hpp"

#include <nmmintrin.h>

#include <boost/crc.hpp>
#include <boost/endian/conversion.hpp>

namespace protocol::hardened {

std::uint32_t crc32c(Pieces pieces) noexcept {
  return has_crc32c_instruction() ? crc32c_by_instruction(pieces) : crc32c_by_library(pieces);
}

[[gnu::target("sse4.2")]] std::uint32_t crc32c_by_instruction(Pieces pieces) noexcept {
  constexpr std::uint32_t all_ones = 0xFFFF'FFFF;
  std::uint64_t remainder = all_ones;
  for (const std::span<const std::byte> piece : pieces) {
    const auto* at = reinterpret_cast<const unsigned char*>(piece.data());
    std::size_t left = piece.size();
    for (; left >= sizeof(std::uint64_t); at += sizeof(std::uint64_t), left -= sizeof(std::uint64_t))
      remainder = _mm_crc32_u64(remainder, boost::endian::load_little_u64(at));
    for (; left > 0; ++at, --left) remainder = _mm_crc32_u8(static_cast<std::uint32_t>(remainder), *at);
  }
  return static_cast<std::uint32_t>(remainder) ^ all_ones;
}

bool has_crc32c_instruction() noexcept { return __builtin_cpu_supports("sse4.2") != 0; }

std::uint32_t crc32c_by_library(Pieces pieces) noexcept {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> checksum;
  for (const std::span<const std::byte> piece : pieces) checksum.process_bytes(piece.data(), piece.size());
  return checksum.checksum();
}

}  // namespace protocol::hardened
