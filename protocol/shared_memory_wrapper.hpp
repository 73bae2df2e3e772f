// The named objects that the kernel and the PLC emulator share, and the division of their memory.
//
//   offset         size   field
//        0            4   state     of the request and of the response
//        4            4   request length in bytes
//        8           RQ   request bytes        RQ = PaperOptions::request_bytes_max
//     8+RQ            4   response length in bytes
//    12+RQ           RS   response bytes       RS = PaperOptions::response_bytes_max
//
// Integers are in host order. One named semaphore belongs to the segment; the master releases it after each
// request. This is the published design, hazards included (README.md lists them): every step is an access of
// its own, and there is no check that the design does not have.
//
// Accesses are relaxed std::atomic_ref operations, the areas byte by byte: that makes them defined in C++
// when both sides touch an area at once, and adds no ordering that the design does not have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/sync/named_semaphore.hpp>
#include <tl/expected.hpp>

#include "protocol/paper_options.hpp"

namespace protocol {

/// K2 = enumeration: what the state word says.
enum class ExchangeState : std::uint32_t { idle = 0, request = 1, response = 2 };

enum class SharedMemoryError : std::uint8_t {
  cannot_open,        ///< the system refused the segment or the semaphore
  segment_too_small,  ///< a segment of that name exists and has no room for the areas asked for
  request_too_long,   ///< more bytes than the request area holds
  semaphore_full,     ///< K4 = one: the post before this one has not been consumed
};

[[nodiscard]] std::string_view to_string(SharedMemoryError error) noexcept;

class SharedMemoryWrapper {
 public:
  SharedMemoryWrapper(const SharedMemoryWrapper&) = delete;
  SharedMemoryWrapper& operator=(const SharedMemoryWrapper&) = delete;

  /// Creates the named objects, or opens those that exist. The one who creates the segment zeroes it (K5).
  [[nodiscard]] tl::expected<void, SharedMemoryError> open() noexcept;
  /// Unmaps and closes; the named objects stay. Closing twice does nothing.
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept;
  /// Whether open() found no segment of that name and made one.
  [[nodiscard]] bool created_segment() const noexcept;

  /// Removes the named objects of `segment_name` from the system.
  /// @return whether there was any
  static bool remove(std::string_view segment_name) noexcept;
  /// Whether a segment or a semaphore of that name exists.
  [[nodiscard]] static bool exists(std::string_view segment_name) noexcept;

  [[nodiscard]] const PaperOptions& options() const noexcept;
  [[nodiscard]] const std::string& segment_name() const noexcept;
};

}  // namespace protocol
