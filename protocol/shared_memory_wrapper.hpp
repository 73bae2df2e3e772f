// The named objects that the kernel and the PLC emulator share, and the division of their memory
// (segment_layout.hpp).
//
// One named semaphore belongs to the segment; the master releases it after each request. This is the
// published design, hazards included (README.md lists them): every step is an access of its own, and there is
// no check that the design does not have.
//
// Accesses are relaxed std::atomic_ref operations, the areas byte by byte: that makes them defined in C++
// when both sides touch an area at once, and adds no ordering that the design does not have. Only K12 adds one.
//
// Boost.Interprocess throws. Opening, and each operation on the semaphore, is caught here and becomes a
// value; everything above is noexcept.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/sync/named_semaphore.hpp>
#include <tl/expected.hpp>

#include "protocol/exchange_observer.hpp"
#include "protocol/paper_options.hpp"
#include "protocol/segment_layout.hpp"
#include "protocol/shared_memory_error.hpp"

namespace protocol {

/// K2 = enumeration: what the state word says.
enum class ExchangeState : std::uint32_t { idle = 0, request = 1, response = 2 };

/// K2 = halves: what the state word is made of.
inline constexpr std::uint32_t request_half = 0x0000'FFFF;
inline constexpr std::uint32_t request_pending = 0x0000'0001;
inline constexpr std::uint32_t response_half = 0xFFFF'0000;
inline constexpr std::uint32_t response_pending = 0x0001'0000;

class SharedMemoryWrapper {
 public:
  SharedMemoryWrapper(const SharedMemoryWrapper&) = delete;
  SharedMemoryWrapper& operator=(const SharedMemoryWrapper&) = delete;

  /// Creates the named objects, or opens those that exist (K5, K10). Opening an open wrapper does nothing.
  [[nodiscard]] tl::expected<void, SharedMemoryError> open() noexcept;
  /// Unmaps and closes; the named objects stay. Closing twice does nothing.
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept;
  /// Whether open() found no segment of that name, or one that nobody had given its size yet.
  [[nodiscard]] bool created_segment() const noexcept;

  /// Removes the named objects of `segment_name` from the system.
  /// @return whether there was any
  static bool remove(std::string_view segment_name) noexcept;
  /// Whether a segment or a semaphore of that name exists.
  [[nodiscard]] static bool exists(std::string_view segment_name) noexcept;

  [[nodiscard]] const PaperOptions& options() const noexcept;
  [[nodiscard]] const std::string& segment_name() const noexcept;
  [[nodiscard]] const SegmentLayout& layout() const noexcept;

 protected:
  /// Which side of the exchange the wrapper serves; K5 makes a difference between them.
  enum class Side : std::uint8_t { master, slave };

  /// @param observer  told of each event of the exchange; must outlive the wrapper; nullptr = nobody listens
  SharedMemoryWrapper(std::string segment_name, const PaperOptions& options, ExchangeObserver* observer,
                      Side side);
  ~SharedMemoryWrapper() = default;

  // The steps of an exchange (README.md names them). All of them need an open wrapper.

  /// w1 w2, or s5 s6: length and bytes in the order of K6.
  /// @param bytes  at most area.capacity_bytes
  void write_area(const AreaLayout& area, std::span<const std::byte> bytes) noexcept;
  /// r2 r3, or s2 s3: length and bytes in the order of K6, with the check of K9.
  ///
  /// With K9 = none the length in the area decides how much is copied, also beyond the area. The copy ends
  /// where the mapped memory or `into` ends, whatever the length says: beyond there is nothing to read.
  /// A length that fails the check of K9 counts as 0.
  /// @return bytes copied
  std::size_t read_area(const AreaLayout& area, std::span<std::byte> into) noexcept;

  /// w3: there is a request.
  void publish_request() noexcept;
  /// r1: one look at the state word.
  [[nodiscard]] bool response_is_published() const noexcept;
  /// r4: the answer has been read.
  void take_back_response() noexcept;
  /// s7: there is an answer.
  void publish_response() noexcept;

  /// w4: releases the semaphore. K4 = one: fails when a post is there that nobody has consumed. POSIX
  /// semaphores have no maximum, so this takes a token back to see whether there is one: two steps.
  /// @return whether the semaphore was released
  bool release_semaphore() noexcept;
  /// s1: waits until the semaphore is released.
  /// @return false when a signal ended the wait and no token was consumed
  bool wait_for_semaphore() noexcept;
  /// @return whether a token was there, and has been consumed
  bool try_consume_semaphore() noexcept;
  /// Releases the semaphore whatever K4 says. Async-signal-safe as long as its count is below SEM_VALUE_MAX.
  /// @return whether the semaphore was released
  bool post_semaphore() noexcept;

  [[nodiscard]] ExchangeObserver& observer() const noexcept;

 private:
  tl::expected<void, SharedMemoryError> open_or_throw();
  void zero_segment() noexcept;

  // The order is a template argument: one that the compiler does not know would become the strongest there is.
  template <std::memory_order order = std::memory_order_relaxed>
  [[nodiscard]] std::uint32_t load_word(std::size_t offset) const noexcept;
  template <std::memory_order order = std::memory_order_relaxed>
  void store_word(std::size_t offset, std::uint32_t value) noexcept;
  [[nodiscard]] std::byte load_byte(std::size_t offset) const noexcept;
  void store_byte(std::size_t offset, std::byte value) noexcept;
  template <std::memory_order order = std::memory_order_relaxed>
  void set_state(ExchangeState state, std::uint32_t cleared_bits, std::uint32_t set_bits) noexcept;
  [[nodiscard]] bool answer_is_ordered() const noexcept;
  [[nodiscard]] std::size_t checked_length(const AreaLayout& area) const noexcept;
  [[nodiscard]] std::uint8_t* at(std::size_t offset) const noexcept;

  std::string segment_name_;
  PaperOptions options_;
  SegmentLayout layout_;
  ExchangeObserver* observer_;
  Side side_;
  bool created_segment_ = false;
  boost::interprocess::mapped_region memory_;
  std::optional<boost::interprocess::named_semaphore> semaphore_;
};

}  // namespace protocol
