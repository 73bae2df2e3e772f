#include "protocol/shared_memory_wrapper.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <utility>

#include <boost/interprocess/shared_memory_object.hpp>

#include "protocol/check.hpp"

namespace protocol {

namespace {

namespace ipc = boost::interprocess;

static_assert(std::atomic_ref<std::uint32_t>::is_always_lock_free, "a lock cannot span processes");
static_assert(std::atomic_ref<std::uint8_t>::is_always_lock_free, "a lock cannot span processes");

std::size_t size_bytes(const ipc::shared_memory_object& segment) {
  ipc::offset_t size = 0;
  return segment.get_size(size) ? static_cast<std::size_t>(size) : 0;
}

bool try_consume(ipc::named_semaphore& semaphore) noexcept {
  try {
    return semaphore.try_wait();
  } catch (const ipc::interprocess_exception&) {
    return false;  // EINTR: nothing was consumed
  }
}

/// K10: gives a semaphore that may be left over the count that a new one has, as long as the segment has no
/// size. Nobody can have posted for this segment then, since posting needs a mapping. Should another process
/// have given the segment its size meanwhile, what was taken may have been its posts: they are given back.
void set_start_count(ipc::named_semaphore& semaphore, const ipc::shared_memory_object& segment,
                     unsigned start_count) {
  unsigned taken_count = 0;
  while (try_consume(semaphore)) ++taken_count;
  const unsigned posts_count = size_bytes(segment) == 0 ? start_count : taken_count;
  for (unsigned i = 0; i < posts_count; ++i) semaphore.post();
}

}  // namespace

SharedMemoryWrapper::SharedMemoryWrapper(std::string segment_name, const PaperOptions& options,
                                         ExchangeObserver* observer, Side side)
    : segment_name_(std::move(segment_name)),
      options_(options),
      layout_(protocol::segment_layout(options)),
      observer_(observer != nullptr ? observer : &silent_observer()),
      side_(side) {}

tl::expected<void, SharedMemoryError> SharedMemoryWrapper::open() noexcept {
  if (is_open()) return {};
  try {
    const auto opened = open_or_throw();
    if (!opened) close();
    return opened;
  } catch (...) {  // interprocess_exception: the system's refusal; bad_alloc: no room for a name
    close();
    return tl::unexpected(SharedMemoryError::cannot_open);
  }
}

tl::expected<void, SharedMemoryError> SharedMemoryWrapper::open_or_throw() {
  const char* const name = segment_name_.c_str();
  const unsigned start_count = options_.semaphore_start == PaperOptions::SemaphoreStart::one ? 1 : 0;
  ipc::shared_memory_object segment(ipc::open_or_create, name, ipc::read_write);
  semaphore_.emplace(ipc::open_or_create, name, start_count);

  const std::size_t found_bytes = size_bytes(segment);
  created_segment_ = found_bytes == 0;
  if (created_segment_) {
    if (options_.semaphore_start != PaperOptions::SemaphoreStart::left_over)
      set_start_count(*semaphore_, segment, start_count);
    // K5, creator: the system fills what it adds with zeros, in the same act. Two processes that come here
    // together ask for the same size, and the second request changes nothing.
    segment.truncate(static_cast<ipc::offset_t>(layout_.size_bytes));
  } else if (found_bytes < layout_.size_bytes) {
    return tl::unexpected(SharedMemoryError::segment_too_small);
  }
  memory_ = ipc::mapped_region(segment, ipc::read_write, 0, layout_.size_bytes);

  using Initialiser = PaperOptions::Initialiser;
  const bool slave_zeroes =
      options_.initialiser == Initialiser::slave || options_.initialiser == Initialiser::creator_and_slave;
  if (side_ == Side::slave && slave_zeroes) zero_segment();
  return {};
}

void SharedMemoryWrapper::close() noexcept {
  memory_ = ipc::mapped_region();
  semaphore_.reset();
  created_segment_ = false;
}

bool SharedMemoryWrapper::is_open() const noexcept { return memory_.get_address() != nullptr; }
bool SharedMemoryWrapper::created_segment() const noexcept { return created_segment_; }
const PaperOptions& SharedMemoryWrapper::options() const noexcept { return options_; }
const std::string& SharedMemoryWrapper::segment_name() const noexcept { return segment_name_; }
const SegmentLayout& SharedMemoryWrapper::layout() const noexcept { return layout_; }
ExchangeObserver& SharedMemoryWrapper::observer() const noexcept { return *observer_; }

bool SharedMemoryWrapper::remove(std::string_view segment_name) noexcept {
  const std::string name(segment_name);
  const bool segment_removed = ipc::shared_memory_object::remove(name.c_str());
  const bool semaphore_removed = ipc::named_semaphore::remove(name.c_str());
  return segment_removed || semaphore_removed;
}

bool SharedMemoryWrapper::exists(std::string_view segment_name) noexcept {
  const std::string name(segment_name);
  try {
    const ipc::shared_memory_object segment(ipc::open_only, name.c_str(), ipc::read_only);
    return true;
  } catch (const ipc::interprocess_exception& refusal) {
    if (refusal.get_error_code() != ipc::not_found_error) return true;  // it is there, and not for us
  }
  try {
    const ipc::named_semaphore semaphore(ipc::open_only, name.c_str());
    return true;
  } catch (const ipc::interprocess_exception& refusal) {
    return refusal.get_error_code() != ipc::not_found_error;
  }
}

void SharedMemoryWrapper::write_area(const AreaLayout& area, std::span<const std::byte> bytes) noexcept {
  PLC_CHECK(is_open() && bytes.size() <= area.capacity_bytes);
  const bool length_first = options_.area_order == PaperOptions::AreaOrder::length_first;
  const auto length = static_cast<std::uint32_t>(bytes.size());
  if (length_first) store_word(area.length_offset, length);
  for (std::size_t i = 0; i < bytes.size(); ++i) store_byte(area.bytes_offset + i, bytes[i]);
  if (!length_first) store_word(area.length_offset, length);
}

std::size_t SharedMemoryWrapper::read_area(const AreaLayout& area, std::span<std::byte> into) noexcept {
  PLC_CHECK(is_open());
  std::size_t copied_bytes = 0;
  const auto copy_up_to = [&](std::size_t end) {
    for (; copied_bytes < end; ++copied_bytes)
      into[copied_bytes] = load_byte(area.bytes_offset + copied_bytes);
  };
  // Whoever copies before knowing the length has to take the whole area.
  if (options_.area_order == PaperOptions::AreaOrder::bytes_first)
    copy_up_to(std::min(area.capacity_bytes, into.size()));
  const std::size_t mapped_bytes = layout_.size_bytes - area.bytes_offset;
  const std::size_t length = std::min({checked_length(area), into.size(), mapped_bytes});
  copy_up_to(length);
  return length;
}

std::size_t SharedMemoryWrapper::checked_length(const AreaLayout& area) const noexcept {
  const std::size_t length = load_word(area.length_offset);
  using LengthCheck = PaperOptions::LengthCheck;
  if (options_.length_check == LengthCheck::none) return length;
  if (length > area.capacity_bytes) return 0;
  return options_.length_check == LengthCheck::load_once ? length : load_word(area.length_offset);
}

void SharedMemoryWrapper::publish_request() noexcept {
  set_state(ExchangeState::request, 0, request_pending);
}

bool SharedMemoryWrapper::response_is_published() const noexcept {
  // Acquire: whoever sees the answer of s7 copies the bytes that were written before it, r2 r3.
  const std::uint32_t state = answer_is_ordered()
                                  ? load_word<std::memory_order_acquire>(SegmentLayout::state_offset)
                                  : load_word(SegmentLayout::state_offset);
  if (options_.state_coding == PaperOptions::StateCoding::halves) return (state & response_half) != 0;
  return state == static_cast<std::uint32_t>(ExchangeState::response);
}

void SharedMemoryWrapper::take_back_response() noexcept { set_state(ExchangeState::idle, response_half, 0); }

void SharedMemoryWrapper::publish_response() noexcept {
  if (answer_is_ordered()) {
    // Release: s5 s6 come before it, for the acquire of r1.
    set_state<std::memory_order_release>(ExchangeState::response, request_half, response_pending);
  } else {
    set_state(ExchangeState::response, request_half, response_pending);
  }
}

bool SharedMemoryWrapper::answer_is_ordered() const noexcept {
  return options_.answer_order == PaperOptions::AnswerOrder::release_and_acquire;
}

template <std::memory_order order>
void SharedMemoryWrapper::set_state(ExchangeState state, std::uint32_t cleared_bits,
                                    std::uint32_t set_bits) noexcept {
  if (options_.state_coding == PaperOptions::StateCoding::enumeration) {
    store_word<order>(SegmentLayout::state_offset, static_cast<std::uint32_t>(state));
    return;
  }
  const std::uint32_t halves = load_word(SegmentLayout::state_offset);
  store_word<order>(SegmentLayout::state_offset, (halves & ~cleared_bits) | set_bits);
}

bool SharedMemoryWrapper::release_semaphore() noexcept {
  if (options_.semaphore_maximum == PaperOptions::SemaphoreMaximum::one && try_consume_semaphore()) {
    post_semaphore();
    return false;
  }
  return post_semaphore();
}

bool SharedMemoryWrapper::wait_for_semaphore() noexcept {
  PLC_CHECK(is_open());
  try {
    semaphore_->wait();
    return true;
  } catch (const ipc::interprocess_exception& refusal) {
    PLC_CHECK(refusal.get_native_error() == EINTR);
    return false;
  }
}

bool SharedMemoryWrapper::try_consume_semaphore() noexcept {
  PLC_CHECK(is_open());
  return try_consume(*semaphore_);
}

bool SharedMemoryWrapper::post_semaphore() noexcept {
  PLC_CHECK(is_open());
  try {
    semaphore_->post();
    return true;
  } catch (const ipc::interprocess_exception&) {
    return false;  // EOVERFLOW: SEM_VALUE_MAX posts that nobody has consumed
  }
}

void SharedMemoryWrapper::zero_segment() noexcept {
  store_word(SegmentLayout::state_offset, 0);
  for (const AreaLayout& area : {layout_.request, layout_.response}) {
    store_word(area.length_offset, 0);
    for (std::size_t i = 0; i < area.capacity_bytes; ++i) store_byte(area.bytes_offset + i, std::byte{0});
  }
}

// Relaxed, all four, but for the state word with K12: the published design orders nothing but by its semaphore
// (hazard H17).

template <std::memory_order order>
std::uint32_t SharedMemoryWrapper::load_word(std::size_t offset) const noexcept {
  return std::atomic_ref(*reinterpret_cast<std::uint32_t*>(at(offset))).load(order);
}

template <std::memory_order order>
void SharedMemoryWrapper::store_word(std::size_t offset, std::uint32_t value) noexcept {
  std::atomic_ref(*reinterpret_cast<std::uint32_t*>(at(offset))).store(value, order);
}

std::byte SharedMemoryWrapper::load_byte(std::size_t offset) const noexcept {
  return std::byte{std::atomic_ref(*at(offset)).load(std::memory_order_relaxed)};
}

void SharedMemoryWrapper::store_byte(std::size_t offset, std::byte value) noexcept {
  std::atomic_ref(*at(offset)).store(std::to_integer<std::uint8_t>(value), std::memory_order_relaxed);
}

std::uint8_t* SharedMemoryWrapper::at(std::size_t offset) const noexcept {
  return static_cast<std::uint8_t*>(memory_.get_address()) + offset;
}

}  // namespace protocol
