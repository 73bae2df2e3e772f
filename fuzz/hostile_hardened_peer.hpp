// What the targets against a hostile peer of the hardened handoff have in common: the peer, a task of the world.
//
// By default he does what the other side would do: puts a whole message into the area, says so in the state word, rings. Each
// choice makes one thing of that wrong, and before each access of either of them one byte of the state word or of the area may
// become 0, 255 or one more than it was. The areas that a side only writes are left alone: nothing there can make a difference
// to it.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "fuzz/hardened_peer.hpp"
#include "protocol/hardened/state_word.hpp"
#include "sim_clock/world/world.hpp"

namespace fuzz {

inline constexpr const char* hardened_segment = "handoff";

/// The segment is there, with nothing but a state word in it, and may be written into by anybody.
/// @param area  that the side reads
inline void leave_to_foreign_writers(ltsim::World& world, const protocol::SegmentLayout& layout,
                                     const protocol::hardened::StateWord& word,
                                     const protocol::AreaLayout& area, std::string_view length_name) {
  constexpr unsigned without_limit = 1'000'000;
  constexpr std::uint64_t points_max = 20'000;
  constexpr std::uint32_t word_bytes = 4;
  world.set_points_max(points_max);
  world.allow_data_races();  // there is nothing else
  std::vector<std::byte> content(layout.size_bytes);
  const std::uint32_t number = protocol::hardened::encode(word);
  std::memcpy(content.data() + protocol::SegmentLayout::state_offset, &number, sizeof number);
  world.leave_segment(hardened_segment, content);
  const auto offset = static_cast<std::uint32_t>(area.length_offset);
  world.grant_in(ltsim::FaultKind::foreign_write, hardened_segment, protocol::SegmentLayout::state_offset,
                 word_bytes, without_limit);
  world.grant_in(ltsim::FaultKind::foreign_write, hardened_segment, offset,
                 static_cast<std::uint32_t>(word_bytes + area.capacity_bytes), without_limit);
  world.single_fetch(hardened_segment, offset, word_bytes, length_name);
}

class HostilePeer {
 public:
  /// When the objects are there.
  /// @param kind  of the messages that the side reads
  /// @param bell  that he rings: its name behind the segment's
  HostilePeer(ltsim::World& world, const protocol::SegmentLayout& layout, reference::Kind kind,
              const char* bell)
      : world_{world},
        layout_{layout},
        kind_{kind},
        segment_{hardened_segment},
        bell_{std::string{hardened_segment} + bell} {}

  /// One deed, and a pause.
  void act() {
    constexpr std::size_t rings_count = 4;
    if (world_.choose("message", 2) == 0) put_message();
    if (world_.choose("length", 2) == 1) put_length();
    if (world_.choose("word", 2) == 0) put_word();
    const std::size_t rings = (1 + world_.choose("rings", rings_count)) % rings_count;
    for (std::size_t i = 0; i < rings; ++i) sem_post(reinterpret_cast<sem_t*>(bell_.bytes().data()));
    std::this_thread::sleep_for(std::chrono::milliseconds{1 + world_.choose("pause", 4)});
  }

  /// What he has put there whole, each before it was there.
  [[nodiscard]] const std::vector<reference::Message>& messages() const noexcept { return messages_; }
  /// Of the request that lies in its area, as far as it is there.
  [[nodiscard]] std::uint64_t session() const noexcept { return request_number_at(8); }

 private:
  [[nodiscard]] const protocol::AreaLayout& area() const noexcept {
    return kind_ == reference::Kind::request ? layout_.request : layout_.response;
  }
  [[nodiscard]] std::uint64_t request_number_at(std::size_t offset) const noexcept {
    std::uint64_t number = 0;
    std::memcpy(&number, segment_.bytes().data() + layout_.request.bytes_offset + offset, sizeof number);
    return number;
  }
  void put_number(std::size_t offset, std::uint32_t number) const noexcept {
    std::memcpy(segment_.bytes().data() + offset, &number, sizeof number);
  }

  void put_message() {
    const bool is_response = kind_ == reference::Kind::response;
    reference::Message message;
    message.flags_or_status = static_cast<std::uint32_t>(world_.choose("status", 5));
    message.session = number(is_response ? session() : 1, "session");
    message.sequence = number(is_response ? request_number_at(16) : ++requests_, "sequence");
    message.slave = number(0, "slave");
    const std::size_t room = area().capacity_bytes - reference::header_bytes;
    // Each message is of another byte, so that one tells which it is.
    message.payload.assign(room - world_.choose("missing", room + 1),
                           static_cast<std::byte>(++messages_count_));
    auto bytes = reference::encode(kind_, message);
    const std::size_t altered = world_.choose("altered", 1 + bytes.size());
    if (altered == 0) {
      messages_.push_back(message);
    } else {
      bytes[altered - 1] ^= std::byte{1};
    }
    std::ranges::copy(bytes, segment_.bytes().begin() + static_cast<std::ptrdiff_t>(area().bytes_offset));
    put_number(area().length_offset, static_cast<std::uint32_t>(bytes.size()));
  }

  std::uint64_t number(std::uint64_t right, const char* what) {
    const std::size_t chosen = world_.choose(what, 3);
    return chosen == 0 ? right : chosen == 1 ? right + 1 : 0;
  }

  void put_length() {
    const auto capacity = static_cast<std::uint32_t>(area().capacity_bytes);
    const std::array lengths{capacity + 1, std::uint32_t{39}, static_cast<std::uint32_t>(layout_.size_bytes),
                             ~0U,          capacity,          std::uint32_t{40}};
    put_number(area().length_offset, lengths[world_.choose("how long", lengths.size())]);
  }

  void put_word() {
    using protocol::hardened::Phase;
    constexpr std::size_t phases_count = 8;
    std::uint32_t word = 0;
    std::memcpy(&word, segment_.bytes().data() + protocol::SegmentLayout::state_offset, sizeof word);
    protocol::hardened::StateWord next = protocol::hardened::decode(word);
    const bool is_asked = next.phase == Phase::request || next.phase == Phase::busy;
    const Phase usual = kind_ == reference::Kind::request ? Phase::request
                        : is_asked                        ? Phase::response
                                                          : Phase::idle;
    const std::size_t phase = static_cast<std::size_t>(usual) + world_.choose("phase", phases_count);
    if (world_.choose("generation", 2) == 1) next = next.in_next_generation(usual);
    if (kind_ == reference::Kind::request || world_.choose("other", 2) == 1) ++next.sequence;
    next.phase = static_cast<Phase>(phase % phases_count);
    put_number(protocol::SegmentLayout::state_offset, protocol::hardened::encode(next));
  }

  ltsim::World& world_;
  protocol::SegmentLayout layout_;
  reference::Kind kind_;
  MappedObject segment_;
  MappedObject bell_;
  std::vector<reference::Message> messages_;
  unsigned messages_count_ = 0;
  std::uint64_t requests_ = 0;
};

}  // namespace fuzz
