#include "protocol/hardened/endpoint.hpp"

#include <sys/random.h>

#include <atomic>
#include <cstring>
#include <utility>

#include "protocol/check.hpp"
#include "protocol/deadline.hpp"
#include "protocol/hardened/message.hpp"

namespace protocol::hardened {

namespace {

std::string request_bell_name(const std::string& segment_name) { return segment_name + ".request"; }
std::string response_bell_name(const std::string& segment_name) { return segment_name + ".response"; }

SharedMemoryError to_shared_memory_error(NamedMemory::Error error) noexcept {
  switch (error) {
    case NamedMemory::Error::cannot_open:
      break;
    case NamedMemory::Error::other_size:
      return SharedMemoryError::other_layout;
  }
  return SharedMemoryError::cannot_open;
}

}  // namespace

tl::expected<void, SharedMemoryError> remove_segment(const std::string& segment_name,
                                                     const Options& options) noexcept {
  Roles roles(segment_name);
  if (const auto taken = roles.take(Side::master, deadline_after(options.open_timeout)); !taken) return taken;
  if (!roles.try_take_other()) return tl::unexpected(SharedMemoryError::role_taken);
  NamedMemory::remove(segment_name);
  Doorbell::remove(request_bell_name(segment_name));
  Doorbell::remove(response_bell_name(segment_name));
  roles.remove();
  return {};
}

bool segment_exists(const std::string& segment_name) noexcept { return Roles::exist(segment_name); }

std::uint64_t random_number() noexcept {
  std::uint64_t number = 0;
  while (number == 0) {
    // So few bytes come whole, and no signal interrupts them (getrandom(2)); before the system has any, it waits.
    PLC_CHECK(::getrandom(&number, sizeof number, 0) == sizeof number);
  }
  return number;
}

Endpoint::Endpoint(std::string segment_name, const Options& options, ExchangeObserver* observer, Side side)
    : segment_name_(std::move(segment_name)),
      options_(options),
      layout_(segment_layout(header_bytes + options.request_bytes_max,
                             header_bytes + options.response_bytes_max)),
      observer_(observer != nullptr ? observer : &silent_observer()),
      side_(side),
      roles_(segment_name_) {}

tl::expected<void, SharedMemoryError> Endpoint::open_objects() noexcept {
  if (const auto taken = roles_.take(side_, deadline_after(options_.open_timeout)); !taken) return taken;
  const auto opened = make_or_open();
  if (!opened) close_objects();
  return opened;
}

tl::expected<void, SharedMemoryError> Endpoint::make_or_open() noexcept {
  if (const auto error = memory_.open(segment_name_, layout_.size_bytes))
    return tl::unexpected(to_shared_memory_error(*error));
  if (roles_.segment() != memory_.identity) {
    // A new one, after a former one whose name is gone. Whoever is still attached to that would never meet us.
    if (roles_.segment() != 0 && !roles_.try_take_other())
      return tl::unexpected(SharedMemoryError::other_segment);
    roles_.set_segment(memory_.identity);
    roles_.give_back_other();
  }
  if (!request_bell_.open(request_bell_name(segment_name_)) ||
      (options_.doorbells == Options::Doorbells::two &&
       !response_bell_.open(response_bell_name(segment_name_)))) {
    return tl::unexpected(SharedMemoryError::cannot_open);
  }
  cell_.emplace(word_at(SegmentLayout::state_offset));
  return {};
}

void Endpoint::close_objects() noexcept {
  cell_.reset();
  request_bell_.close();
  response_bell_.close();
  memory_.close();
  roles_.give_back();
}

void Endpoint::attach(StateWord (*after)(const StateWord&) noexcept) noexcept {
  for (;;) {
    const StateWord found = look();
    StateWord next = after(found);
    if (!options_.rules.generation_advances) next.generation = found.generation;
    if (next == found || move(found, next, options_.orders.attach)) break;
  }
  observer().attached();
  roles_.made();
}

bool Endpoint::move(const StateWord& from, const StateWord& to, std::memory_order order, bool rule) noexcept {
  if (!rule) {
    cell_->store(to);
  } else if (!cell_->swap(from, to, order)) {
    return false;
  }
  observer().moved(encode(from), encode(to));
  return true;
}

void Endpoint::write_area(const AreaLayout& area, std::span<const std::byte> message) noexcept {
  PLC_CHECK(message.size() <= area.capacity_bytes);
  std::memcpy(at(area.bytes_offset), message.data(), message.size());
  // Relaxed, here and below: the move of the state word that hands the area over orders it.
  std::atomic_ref(word_at(area.length_offset))
      .store(static_cast<std::uint32_t>(message.size()), std::memory_order_relaxed);
}

std::optional<std::span<const std::byte>> Endpoint::read_area(const AreaLayout& area,
                                                              std::span<std::byte> into) const noexcept {
  const std::size_t length = std::atomic_ref(word_at(area.length_offset)).load(std::memory_order_relaxed);
  if (length < header_bytes || length > area.capacity_bytes) return std::nullopt;
  std::memcpy(into.data(), at(area.bytes_offset), length);
  return into.first(length);
}

std::uint32_t& Endpoint::word_at(std::size_t offset) const noexcept {
  return *reinterpret_cast<std::uint32_t*>(at(offset));
}

std::byte* Endpoint::at(std::size_t offset) const noexcept {
  return static_cast<std::byte*>(memory_.region.get_address()) + offset;
}

}  // namespace protocol::hardened
