// CRC-32C (Castagnoli), as in RFC 3720: reflected, all ones before and after.
#pragma once

#include <cstdint>

#include <boost/crc.hpp>

namespace protocol::hardened {

/// process_bytes() takes the bytes, one piece after the other; checksum() is the result.
using Crc32c = boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true>;

}  // namespace protocol::hardened
