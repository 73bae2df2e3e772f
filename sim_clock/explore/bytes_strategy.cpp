#include "sim_clock/explore/bytes_strategy.hpp"

#include <algorithm>

namespace ltsim {
namespace {

constexpr std::size_t as_index(BytesStrategy::Kind kind) noexcept { return static_cast<std::size_t>(kind); }

}  // namespace

BytesStrategy::Record BytesStrategy::read(std::span<const std::byte> bytes) noexcept {
  const auto at = [&](std::size_t i) { return i < bytes.size() ? std::to_integer<unsigned>(bytes[i]) : 0U; };
  return {.kind = static_cast<std::uint8_t>(at(0) % kinds_count),
          .skipped_count = static_cast<std::uint16_t>(at(1) | at(2) << 8U),
          .value = static_cast<std::uint16_t>(at(3) | at(4) << 8U)};
}

void BytesStrategy::write(const Record& record, std::span<std::byte, record_bytes> into) noexcept {
  into[0] = static_cast<std::byte>(record.kind);
  into[1] = static_cast<std::byte>(record.skipped_count);
  into[2] = static_cast<std::byte>(record.skipped_count >> 8U);
  into[3] = static_cast<std::byte>(record.value);
  into[4] = static_cast<std::byte>(record.value >> 8U);
}

std::vector<std::string_view> BytesStrategy::split(std::string_view bytes) {
  std::vector<std::string_view> records;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(record_bytes, bytes.size())))
    records.push_back(bytes.substr(0, record_bytes));
  return records;
}

void BytesStrategy::begin_execution(std::uint64_t /*seed*/) noexcept {
  for (std::size_t kind = 0; kind < kinds_count; ++kind)
    most_decisions_[kind] = std::max(most_decisions_[kind], decisions_[kind]);
  decisions_.fill(0);
  cursors_.fill(Cursor{.next = 0, .decisions_before = none, .value = 0});
  // The first record of each kind; in one pass, as most kinds have none.
  for (std::size_t at = 0; at < bytes_.size(); at += record_bytes) {
    const Record record = read(bytes_.subspan(at));
    Cursor& cursor = cursors_[record.kind];
    if (cursor.decisions_before != none) continue;
    cursor = {.next = at + record_bytes, .decisions_before = record.skipped_count, .value = record.value};
  }
}

void BytesStrategy::advance(std::size_t kind) noexcept {
  Cursor& cursor = cursors_[kind];
  for (; cursor.next < bytes_.size(); cursor.next += record_bytes) {
    const Record record = read(bytes_.subspan(cursor.next));
    if (record.kind != kind) continue;
    cursor.next += record_bytes;
    cursor.decisions_before = record.skipped_count;
    cursor.value = record.value;
    return;
  }
  cursor.decisions_before = none;
}

std::uint16_t BytesStrategy::take(std::size_t kind) noexcept {
  const std::uint16_t value = cursors_[kind].value;
  advance(kind);
  return value;
}

std::size_t BytesStrategy::choose_task(const TaskChoice& choice) noexcept {
  constexpr std::size_t kind = as_index(Kind::task);
  return is_due(kind) ? 1 + take(kind) % (choice.options.size() - 1) : 0;
}

SlowMoment BytesStrategy::slow_moment(const SlowMomentChoice& choice) noexcept {
  const auto moment = [&](Kind kind, bool others_go_on) -> SlowMoment {
    const std::size_t chosen = take(as_index(kind)) % (durations.size() + 1);
    if (chosen != 0) return {.duration = durations[chosen - 1], .others_go_on = others_go_on};
    const bool armed = choice.until_next_timer != VirtualClock::never;
    return {.duration = armed ? choice.until_next_timer : durations.front(), .others_go_on = others_go_on};
  };
  if (is_due(as_index(Kind::slow_machine))) return moment(Kind::slow_machine, false);
  if (choice.running_can_be_held_up && is_due(as_index(Kind::slow_task)))
    return moment(Kind::slow_task, true);
  return {};
}

std::size_t BytesStrategy::strike(FaultKind fault, std::size_t variants_count) noexcept {
  const std::size_t kind = kind_of(fault);
  return is_due(kind) ? 1 + take(kind) % variants_count : 0;
}

std::size_t BytesStrategy::answer(std::size_t count) noexcept {
  constexpr std::size_t kind = as_index(Kind::answer);
  return is_due(kind) ? 1 + take(kind) % (count - 1) : 0;
}

std::size_t BytesStrategy::choose_age(const AgeChoice& choice) noexcept {
  return is_due(age_kind) ? 1 + take(age_kind) % (choice.ages.size() - 1) : 0;
}

}  // namespace ltsim
