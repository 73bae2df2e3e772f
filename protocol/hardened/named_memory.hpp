// A named piece of shared memory, mapped, and which one it is.
//
// Boost.Interprocess throws on opening; here that becomes a value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <boost/interprocess/mapped_region.hpp>

namespace protocol::hardened {

/// Tells the objects of one name apart: the number of the file behind it. All shared memory lies on one file system.
using MemoryIdentity = std::uint64_t;

struct NamedMemory {
  enum class Error : std::uint8_t {
    cannot_open,  ///< the system refused it
    other_size,   ///< it is there, and not as large as it should be
  };

  boost::interprocess::mapped_region region;
  MemoryIdentity identity = 0;

  /// Makes it, filled with zeros, or opens the one that is there. One that has no size is one whose maker has not come
  /// further: it is given its size. Openers that meet here must ask for the same size, or take turns.
  /// @return nothing if it is open; otherwise this is as it was
  [[nodiscard]] std::optional<Error> open(const std::string& name, std::size_t size_bytes) noexcept;
  void close() noexcept { *this = {}; }
  [[nodiscard]] bool is_open() const noexcept { return region.get_address() != nullptr; }

  /// What is there under the name at the moment; nothing if nothing is.
  [[nodiscard]] static std::optional<MemoryIdentity> identity_of(const std::string& name) noexcept;
  /// @return whether there was one of that name
  static bool remove(const std::string& name) noexcept;
};

}  // namespace protocol::hardened
