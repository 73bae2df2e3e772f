// What the targets against a foreign writer of the hardened handoff have in common: the named objects, mapped by somebody who has
// no business there, and the script of what he does with them, which is read from the input as far as it is wanted.
//
//   script   any number of deeds, one byte each (its remainder by 9) and what belongs to it:
//     0      the end of what he does at this step; so is the end of the input
//     1 w4   the state word becomes w
//     2 a    phase a % 8 into the state word, a / 8 % 4 added to its generation, a / 32 % 8 to its sequence
//     3 at2 n b...       n % 64 bytes from `at` on, a remainder
//     4 f s q v n b...   a whole message into the side's area, with its length: flags or status f, session s, sequence q, slave v,
//                        n % 40 bytes; s, q and v: 0 the right one, 1 zero, 2 one more than the right one, otherwise the number itself
//     5      the right checksum for what lies in that area, if its length is one
//     6 w4   the length of that area becomes w
//     7 b    a doorbell, b % 2: the slave's or the master's; b / 2 % 8 rings, or with 7 as many as a semaphore may have
//     8 a w4 one of the words before the locks, a % 4: it becomes w
//
// Only what says who writes which bytes is written over: the locks and the semaphores belong to the system's library, which
// makes no promise about others who write there.
#pragma once

#include <fcntl.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fuzz/hardened_reference.hpp"
#include "protocol/hardened/endpoint.hpp"
#include "protocol/hardened/options.hpp"
#include "protocol/segment_layout.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace fuzz {

/// Capacities of 56 and 64 bytes: one area is not as large as the other, and both are small enough for a script.
inline protocol::hardened::Options small_hardened_options() {
  protocol::hardened::Options options;
  options.request_bytes_max = 16;
  options.response_bytes_max = 24;
  return options;
}

/// A semaphore is emptied ring by ring: no more of them than take a moment.
inline constexpr int emptied_rings_max = 1 << 16;

inline protocol::SegmentLayout layout_of(const protocol::hardened::Options& options) {
  return protocol::segment_layout(protocol::hardened::header_bytes + options.request_bytes_max,
                                  protocol::hardened::header_bytes + options.response_bytes_max);
}

/// A shared memory object that is there, mapped with the rest of its last page.
class MappedObject {
 public:
  explicit MappedObject(const std::string& name) {
    const int descriptor = shm_open(("/" + name).c_str(), O_RDWR, 0);
    struct stat status{};
    ltsim::expect(descriptor >= 0 && fstat(descriptor, &status) == 0, "an object of the handoff is there");
    bytes_ = static_cast<std::size_t>(status.st_size);
    memory_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    close(descriptor);
    ltsim::expect(memory_ != MAP_FAILED, "an object of the handoff can be mapped");
  }
  ~MappedObject() { munmap(memory_, bytes_); }
  MappedObject(const MappedObject&) = delete;
  MappedObject& operator=(const MappedObject&) = delete;

  [[nodiscard]] std::span<std::byte> bytes() const noexcept {
    return {static_cast<std::byte*>(memory_), bytes_};
  }

 private:
  std::size_t bytes_ = 0;
  void* memory_ = nullptr;
};

/// The input, from its beginning; zeros behind its end.
class Script {
 public:
  explicit Script(std::span<const std::byte> input) : left_{input} {}

  [[nodiscard]] bool is_over() const noexcept { return left_.empty(); }
  std::uint8_t byte() noexcept { return static_cast<std::uint8_t>(number(1)); }
  std::uint32_t word() noexcept { return number(4); }
  std::uint16_t half() noexcept { return static_cast<std::uint16_t>(number(2)); }
  /// @return fewer than `count` at the end
  std::span<const std::byte> bytes(std::size_t count) noexcept {
    const auto taken = left_.first(std::min(count, left_.size()));
    left_ = left_.subspan(taken.size());
    return taken;
  }

 private:
  std::uint32_t number(std::size_t count) noexcept {
    std::uint32_t number = 0;
    const auto taken = bytes(count);
    for (std::size_t i = 0; i < taken.size(); ++i)
      number |= std::to_integer<std::uint32_t>(taken[i]) << 8 * i;
    return number;
  }

  std::span<const std::byte> left_;
};

class ForeignWriter {
 public:
  /// What is the right one where a message says which request it belongs to.
  struct Right {
    std::uint64_t session = 0;
    std::uint64_t sequence = 0;
    std::uint64_t slave = 0;
  };

  /// @param name  of a segment whose objects are there
  /// @param kind  of the messages that the side reads
  ForeignWriter(const std::string& name, const protocol::hardened::Options& options, reference::Kind kind,
                Script& script)
      : layout_{layout_of(options)},
        kind_{kind},
        area_{kind == reference::Kind::request ? layout_.request : layout_.response},
        script_{script},
        segment_{name},
        roles_{name + ".roles"},
        bells_{MappedObject{name + ".request"}, MappedObject{name + ".response"}} {}

  /// The script, as far as it goes now.
  void act(const Right& right) {
    constexpr unsigned deeds = 9;
    while (!script_.is_over()) {
      switch (script_.byte() % deeds) {
        case 0:
          return;
        case 1:
          set_word(script_.word());
          break;
        case 2: {
          const unsigned change = script_.byte();
          const std::uint32_t now = word();
          const std::uint32_t generation = ((now >> 3U) + (change >> 3U & 3U)) & 0x1FFFU;
          const std::uint32_t sequence = ((now >> 16U) + (change >> 5U)) & 0xFFFFU;
          set_word((change & 7U) | generation << 3U | sequence << 16U);
          break;
        }
        case 3: {
          const std::size_t at = script_.half() % layout_.size_bytes;
          const auto bytes = script_.bytes(script_.byte() % 64U);
          std::ranges::copy(bytes.first(std::min(bytes.size(), layout_.size_bytes - at)),
                            segment().begin() + static_cast<std::ptrdiff_t>(at));
          break;
        }
        case 4:
          put_message(right);
          break;
        case 5:
          if (const auto message = message_in_area()) reference::seal(*message);
          break;
        case 6:
          set_length(script_.word());
          break;
        case 7:
          ring();
          break;
        default: {
          constexpr std::size_t words = 4;  // published, claimed, segment
          const std::size_t at = script_.byte() % words * sizeof(std::uint32_t);
          const std::uint32_t value = script_.word();
          std::memcpy(roles_.bytes().data() + at, &value, sizeof value);
        }
      }
    }
  }

  [[nodiscard]] std::span<std::byte> segment() const noexcept { return segment_.bytes(); }
  [[nodiscard]] std::uint32_t word() const noexcept {
    return number_at(protocol::SegmentLayout::state_offset);
  }
  void set_word(std::uint32_t word) const noexcept {
    set_number(protocol::SegmentLayout::state_offset, word);
  }
  /// What the side reads: the area, as long as its length says, if that is one.
  [[nodiscard]] std::optional<std::span<std::byte>> message_in_area() const noexcept {
    const std::uint32_t length = number_at(area_.length_offset);
    if (length < reference::header_bytes || length > area_.capacity_bytes) return std::nullopt;
    return segment().subspan(area_.bytes_offset, length);
  }
  [[nodiscard]] int rings(std::size_t bell) const noexcept {
    int count = 0;
    sem_getvalue(semaphore(bell), &count);
    return count;
  }

 private:
  [[nodiscard]] std::uint32_t number_at(std::size_t offset) const noexcept {
    std::uint32_t number = 0;
    std::memcpy(&number, segment().data() + offset, sizeof number);
    return number;
  }
  void set_number(std::size_t offset, std::uint32_t number) const noexcept {
    std::memcpy(segment().data() + offset, &number, sizeof number);
  }
  void set_length(std::uint32_t length) const noexcept { set_number(area_.length_offset, length); }
  [[nodiscard]] sem_t* semaphore(std::size_t bell) const noexcept {
    return reinterpret_cast<sem_t*>(bells_[bell].bytes().data());
  }

  std::uint64_t one_of(std::uint64_t right) noexcept {
    const std::uint64_t which = script_.byte();
    return which == 0 ? right : which == 1 ? 0 : which == 2 ? right + 1 : which;
  }

  void put_message(const Right& right) {
    constexpr std::size_t payload_bytes_max = 40;  // there is room for 16 and 24
    reference::Message message;
    message.flags_or_status = script_.byte();
    message.session = one_of(right.session);
    message.sequence = one_of(right.sequence);
    message.slave = one_of(right.slave);
    const auto payload = script_.bytes(script_.byte() % payload_bytes_max);
    message.payload.assign(payload.begin(), payload.end());
    const auto bytes = reference::encode(kind_, message);
    std::ranges::copy(std::span{bytes}.first(std::min(bytes.size(), area_.capacity_bytes)),
                      segment().begin() + static_cast<std::ptrdiff_t>(area_.bytes_offset));
    set_length(static_cast<std::uint32_t>(bytes.size()));
  }

  void ring() noexcept {
    constexpr unsigned all = 7;
    const unsigned how = script_.byte();
    sem_t* const bell = semaphore(how % 2U);
    const unsigned count = how / 2U % 8U;
    if (count == all) {
      sem_init(bell, 1, SEM_VALUE_MAX);
    } else {
      for (unsigned i = 0; i < count; ++i) sem_post(bell);
    }
  }

  protocol::SegmentLayout layout_;
  reference::Kind kind_;
  protocol::AreaLayout area_;
  Script& script_;
  MappedObject segment_;
  MappedObject roles_;
  MappedObject bells_[2];
};

/// The objects of a segment, made by a side that has come and gone. Their names go away with it, or before, so that a run that
/// ends in the middle leaves nothing behind.
template <typename Side>
class MadeSegment {
 public:
  MadeSegment(std::string name, const protocol::hardened::Options& options) : name_{std::move(name)} {
    remove();
    Side side{name_, options};
    ltsim::expect(side.open().has_value(), "the objects of the handoff can be made");
  }
  ~MadeSegment() { remove(); }
  MadeSegment(const MadeSegment&) = delete;
  MadeSegment& operator=(const MadeSegment&) = delete;

  /// Not by remove_segment(), whose locks may be written over.
  void remove() const noexcept {
    for (const char* suffix : {"", ".roles", ".request", ".response"})
      shm_unlink(("/" + name_ + suffix).c_str());
  }

 private:
  std::string name_;
};

/// The errors that open() is said to have.
inline bool is_refusal_to_open(protocol::SharedMemoryError error) noexcept {
  using enum protocol::SharedMemoryError;
  return error == cannot_open || error == role_taken || error == not_made_in_time || error == other_layout ||
         error == other_segment;
}

}  // namespace fuzz
