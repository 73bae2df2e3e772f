#include "sim_clock/explore/record_mutator.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace ltsim {
namespace {

constexpr std::size_t record_bytes = BytesStrategy::record_bytes;
using RecordBytes = std::array<std::byte, record_bytes>;

std::span<std::byte, record_bytes> record_at(std::span<std::byte> data, std::size_t index) noexcept {
  return data.subspan(index * record_bytes).first<record_bytes>();
}

}  // namespace

std::size_t RecordMutator::mutate(std::span<std::byte> data, std::size_t size) noexcept {
  const std::size_t room = data.size() / record_bytes;
  std::size_t count = std::min(size / record_bytes, room);
  if (room == 0) return size;
  const auto put_in = [&](std::size_t at, const RecordBytes& record) {
    std::memmove(data.data() + (at + 1) * record_bytes, data.data() + at * record_bytes,
                 (count - at) * record_bytes);
    std::ranges::copy(record, record_at(data, at).begin());
    ++count;
  };
  enum Change : std::uint8_t { put_new, take_away, repeat, exchange, change, change_more, changes_count };
  Change drawn = static_cast<Change>(below(changes_count));
  if (count == 0) drawn = put_new;
  if (count == room && (drawn == put_new || drawn == repeat)) drawn = take_away;
  switch (drawn) {
    case put_new: {
      RecordBytes record;
      BytesStrategy::write(draw(), record);
      put_in(below(count + 1), record);
      break;
    }
    case take_away: {
      const std::size_t at = below(count);
      std::memmove(data.data() + at * record_bytes, data.data() + (at + 1) * record_bytes,
                   (count - at - 1) * record_bytes);
      --count;
      break;
    }
    case repeat: {
      RecordBytes record;
      std::ranges::copy(record_at(data, below(count)), record.begin());
      put_in(below(count + 1), record);
      break;
    }
    case exchange:
      std::ranges::swap_ranges(record_at(data, below(count)), record_at(data, below(count)));
      break;
    case change:
    case change_more:
    case changes_count:
      change_field(record_at(data, below(count)));
      break;
  }
  return count * record_bytes;
}

std::size_t RecordMutator::splice(std::span<const std::byte> one, std::span<const std::byte> other,
                                  std::span<std::byte> into) noexcept {
  const std::size_t room = into.size() / record_bytes;
  const std::size_t first_count = std::min(below(one.size() / record_bytes + 1), room);
  const std::size_t other_count = other.size() / record_bytes;
  const std::size_t last_count = std::min(below(other_count + 1), room - first_count);
  std::ranges::copy(one.first(first_count * record_bytes), into.begin());
  std::ranges::copy(other.subspan((other_count - last_count) * record_bytes, last_count * record_bytes),
                    into.begin() + static_cast<std::ptrdiff_t>(first_count * record_bytes));
  return (first_count + last_count) * record_bytes;
}

RecordMutator::Record RecordMutator::draw() noexcept {
  const std::uint8_t kind = draw_kind();
  return {.kind = kind, .skipped_count = draw_skipped(kind), .value = draw_number()};
}

std::uint8_t RecordMutator::draw_kind() noexcept {
  const std::size_t asked =
      BytesStrategy::kinds_count - static_cast<std::size_t>(std::ranges::count(decisions_, std::uint32_t{0}));
  if (asked == 0) return static_cast<std::uint8_t>(below(BytesStrategy::kinds_count));
  std::size_t left = below(asked);
  std::size_t kind = 0;
  while (decisions_[kind] == 0 || left-- != 0) ++kind;
  return static_cast<std::uint8_t>(kind);
}

std::uint16_t RecordMutator::draw_skipped(std::uint8_t kind) noexcept {
  constexpr std::uint32_t skipped_max = 0xffff;
  const std::uint32_t bound = std::clamp(decisions_[kind], std::uint32_t{1}, skipped_max);
  return static_cast<std::uint16_t>(random_.bits(1) == 0 ? below(bound) : draw_number() % bound);
}

std::uint16_t RecordMutator::draw_number() noexcept {
  constexpr unsigned bits_max = 16;
  const unsigned bits = static_cast<unsigned>(below(bits_max));
  return static_cast<std::uint16_t>(random_.bits(bits + 1));
}

void RecordMutator::change_field(std::span<std::byte, record_bytes> bytes) noexcept {
  Record record = BytesStrategy::read(bytes);
  constexpr std::uint16_t step_max = 4;
  const auto step = [&](std::uint16_t& number) {
    const auto by = static_cast<std::uint16_t>(1 + below(step_max));
    number = static_cast<std::uint16_t>(random_.bits(1) == 0 ? number + by : number - by);
  };
  enum Field : std::uint8_t { kind, skipped, skipped_near_by, value, value_near_by, fields_count };
  switch (static_cast<Field>(below(fields_count))) {
    case kind:
      record.kind = draw_kind();
      break;
    case skipped:
      record.skipped_count = draw_skipped(record.kind);
      break;
    case skipped_near_by:
      step(record.skipped_count);
      break;
    case value:
      record.value = draw_number();
      break;
    case value_near_by:
    case fields_count:
      step(record.value);
      break;
  }
  BytesStrategy::write(record, bytes);
}

}  // namespace ltsim
