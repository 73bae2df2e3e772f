// CRC-32C (Castagnoli), as in RFC 3720: reflected, all ones before and after.
//
// Eight bytes a step, by eight tables (Kounavis and Berry, "slicing-by-8"): byte by byte, the checksums were most of what
// an exchange of 512 bytes costs (tests/bench/handoff_bench). No instructions of one processor, so no second way to test.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <boost/endian/conversion.hpp>

namespace protocol::hardened {

class Crc32c {
 public:
  /// The next piece of the bytes.
  void process(std::span<const std::byte> bytes) noexcept {
    const auto* at = reinterpret_cast<const unsigned char*>(bytes.data());
    std::size_t left = bytes.size();
    for (; left >= slices; at += slices, left -= slices) {
      const std::uint64_t next = boost::endian::load_little_u64(at) ^ remainder_;
      remainder_ = 0;
      for (std::size_t i = 0; i < slices; ++i) remainder_ ^= tables[slices - 1 - i][next >> 8U * i & 0xFFU];
    }
    for (; left > 0; ++at, --left) remainder_ = remainder_ >> 8U ^ tables[0][(remainder_ ^ *at) & 0xFFU];
  }

  /// @return of all bytes so far
  [[nodiscard]] std::uint32_t checksum() const noexcept { return ~remainder_; }

 private:
  static constexpr std::size_t slices = 8;
  using Table = std::array<std::uint32_t, 256>;

  /// tables[k][byte]: the remainder of that byte and k zeros after it.
  static constexpr std::array<Table, slices> make_tables() noexcept {
    constexpr std::uint32_t polynomial = 0x82F6'3B78;  // 1EDC6F41, reflected
    std::array<Table, slices> made{};
    for (std::uint32_t byte = 0; byte < made[0].size(); ++byte) {
      std::uint32_t remainder = byte;
      for (int bit = 0; bit < 8; ++bit)
        remainder = remainder >> 1U ^ ((remainder & 1U) != 0 ? polynomial : 0U);
      made[0][byte] = remainder;
    }
    for (std::size_t k = 1; k < slices; ++k) {
      for (std::size_t byte = 0; byte < made[k].size(); ++byte) {
        const std::uint32_t before = made[k - 1][byte];
        made[k][byte] = before >> 8U ^ made[0][before & 0xFFU];
      }
    }
    return made;
  }
  static const std::array<Table, slices> tables;

  std::uint32_t remainder_ = 0xFFFF'FFFF;
};

inline constexpr std::array<Crc32c::Table, Crc32c::slices> Crc32c::tables = make_tables();

}  // namespace protocol::hardened
