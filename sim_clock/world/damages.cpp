#include "sim_clock/world/damages.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

constexpr std::size_t bits_per_byte = 8;
constexpr std::size_t writes_per_byte = 3;  // zeroes, ones, one more

constexpr std::size_t ways_per_byte(FaultKind kind) noexcept {
  return kind == FaultKind::bit_flip ? bits_per_byte : writes_per_byte;
}

constexpr std::byte damaged(FaultKind kind, std::byte value, std::size_t way) noexcept {
  if (kind == FaultKind::bit_flip) return value ^ std::byte{1} << way;
  if (way == 0) return std::byte{0x00};
  if (way == 1) return std::byte{0xff};
  return static_cast<std::byte>(std::to_integer<unsigned>(value) + 1);
}

}  // namespace

void Damages::reset() noexcept {
  left_ = 0;
  grants_.clear();
}

void Damages::grant(FaultKind kind, std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                    unsigned times) {
  grants_.push_back(
      {.kind = kind, .segment = std::string{segment}, .offset = offset, .bytes = bytes, .left = times});
  left_ += times;
}

void Damages::choose(std::string_view segment, std::span<std::byte> memory) noexcept {
  for (const FaultKind kind : {FaultKind::bit_flip, FaultKind::foreign_write}) choose(kind, segment, memory);
}

void Damages::choose(FaultKind kind, std::string_view segment, std::span<std::byte> memory) noexcept {
  const auto ways_of = [&](const Grant& grant) -> std::size_t {
    if (grant.kind != kind || grant.left == 0 || grant.segment != segment || grant.offset >= memory.size())
      return 0;
    return std::min<std::size_t>(grant.bytes, memory.size() - grant.offset) * ways_per_byte(kind);
  };
  std::size_t ways = 0;
  for (const Grant& grant : grants_) ways += ways_of(grant);
  if (ways == 0) return;
  std::size_t way = world_.scheduler().strike(kind, ways);
  if (way == 0) return;
  --way;
  for (Grant& grant : grants_) {
    const std::size_t of_this = ways_of(grant);
    if (way < of_this) return strike(grant, memory, way);
    way -= of_this;
  }
}

void Damages::strike(Grant& grant, std::span<std::byte> memory, std::size_t way) noexcept {
  --grant.left;
  --left_;
  const std::size_t at = grant.offset + way / ways_per_byte(grant.kind);
  const std::byte before = memory[at];
  memory[at] = damaged(grant.kind, before, way % ways_per_byte(grant.kind));
  world_.checks().accept_change(static_cast<SharedPlace>(&memory[at] - world_.segments().memory()), 1);
  world_.note([&] {
    return fmt::format("fault: {}: byte {} of {} was {:#04x} and becomes {:#04x}", to_string(grant.kind), at,
                       grant.segment, std::to_integer<unsigned>(before),
                       std::to_integer<unsigned>(memory[at]));
  });
}

void Damages::add_state(StateHash& hash) const noexcept {
  for (const Grant& grant : grants_) hash.add(grant.left);
}

}  // namespace ltsim
