// What both sides of the hardened handoff have: the role, the named objects, the areas, and the single moves of the
// state word.
//
// A segment called NAME is the shared memory objects NAME and NAME.roles, and the doorbells NAME.request and
// NAME.response (the second one only with two). Fresh memory is all zeros, so its state word is RAW, which is
// all the initialisation that it needs: a slave's attach makes it IDLE. An object that is there already is used as it
// stands, never judged by its content or its age.
//
// Area bytes are copied plainly: the state word says whose they are, and the moves that hand them over order the copies
// (Orders). Each length is loaded once and bounded before anything is copied.
//
// One thread opens, and closes, and lives as long as the endpoint is open.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <tl/expected.hpp>

#include "protocol/exchange_observer.hpp"
#include "protocol/hardened/doorbell.hpp"
#include "protocol/hardened/named_memory.hpp"
#include "protocol/hardened/options.hpp"
#include "protocol/hardened/roles.hpp"
#include "protocol/hardened/state_cell.hpp"
#include "protocol/segment_layout.hpp"
#include "protocol/shared_memory_error.hpp"

namespace protocol::hardened {

/// Removes the named objects of a segment on which nobody plays a role.
/// @return role_taken, not_made_in_time, cannot_open: nothing was removed
[[nodiscard]] tl::expected<void, SharedMemoryError> remove_segment(const std::string& segment_name,
                                                                   const Options& options = {}) noexcept;

/// Whether there are named objects of the hardened handoff, whatever their state.
[[nodiscard]] bool segment_exists(const std::string& segment_name) noexcept;

class Endpoint {
 public:
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;

  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] const std::string& segment_name() const noexcept { return segment_name_; }
  [[nodiscard]] const SegmentLayout& layout() const noexcept { return layout_; }

 protected:
  /// @param observer  see SharedMemoryWrapper
  Endpoint(std::string segment_name, const Options& options, ExchangeObserver* observer, Side side);
  ~Endpoint() = default;

  /// Takes the role and opens the named objects, which it makes where they are missing. Nobody else opens, or attaches,
  /// until attach(): who attaches later has seen every attach before. The state word is not touched.
  [[nodiscard]] tl::expected<void, SharedMemoryError> open_objects() noexcept;
  void close_objects() noexcept;
  [[nodiscard]] bool has_objects() const noexcept { return cell_.has_value(); }

  // All of these need the objects.

  /// The end of opening. Puts the state word that an attach makes of the present one in its place.
  /// @param after  after_slave_attach or after_master_attach
  void attach(StateWord (*after)(const StateWord&) noexcept) noexcept;

  /// For a swap, which finds out whether it still holds.
  [[nodiscard]] StateWord look() const noexcept { return cell_->load(std::memory_order_relaxed); }
  /// For the use of an area that it says is one's own.
  [[nodiscard]] StateWord look_before_use() const noexcept { return cell_->load(options_.orders.look); }
  /// @param rule  that this is a swap; without it, a store
  /// @return whether `from` was still there
  bool move(const StateWord& from, const StateWord& to, std::memory_order order, bool rule = true) noexcept;

  /// By the area's owner.
  /// @param message  at most area.capacity_bytes
  void write_area(const AreaLayout& area, std::span<const std::byte> message) noexcept;
  /// By the area's owner.
  /// @param into  at least area.capacity_bytes
  /// @return      the copy; nothing if the area's length lies outside of header_bytes to area.capacity_bytes
  [[nodiscard]] std::optional<std::span<const std::byte>> read_area(const AreaLayout& area,
                                                                    std::span<std::byte> into) const noexcept;

  /// To the slave.
  [[nodiscard]] const Doorbell& request_bell() const noexcept { return request_bell_; }
  /// To the master; open only with two doorbells.
  [[nodiscard]] const Doorbell& response_bell() const noexcept { return response_bell_; }
  [[nodiscard]] bool has_response_bell() const noexcept { return response_bell_.is_open(); }

  [[nodiscard]] ExchangeObserver& observer() const noexcept { return *observer_; }

 private:
  [[nodiscard]] tl::expected<void, SharedMemoryError> make_or_open() noexcept;
  [[nodiscard]] std::uint32_t& word_at(std::size_t offset) const noexcept;
  [[nodiscard]] std::byte* at(std::size_t offset) const noexcept;

  std::string segment_name_;
  Options options_;
  SegmentLayout layout_;
  ExchangeObserver* observer_;
  Side side_;
  Roles roles_;
  NamedMemory memory_;
  Doorbell request_bell_;
  Doorbell response_bell_;
  std::optional<StateCell> cell_;
};

/// For a session, and for a slave: a number that no other has.
/// @return not 0
[[nodiscard]] std::uint64_t random_number() noexcept;

}  // namespace protocol::hardened
