#include "tests/kernel_mocks/scripted_plc.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

// fx-protocol, legacy map: M n at 0100H + n/8, D n at 1000H + 2n, forced M at 0800H + n,
// M8000 and up at 0F00H.
constexpr std::size_t m_base = 0x0100;
constexpr std::size_t d_base = 0x1000;
constexpr std::uint16_t m_force_base = 0x0800;
constexpr std::uint16_t special_m_force_base = 0x0F00;
constexpr std::uint16_t status_address = m_base + 15;
constexpr std::uint16_t strobe_address = m_base + 12;

}  // namespace

ScriptedPlc::ScriptedPlc() : scan{obey} {
  set_bit(122, true);
  set_bit(123, true);
  set_bit(125, true);
  set_bit(126, true);
}

void ScriptedPlc::obey(ScriptedPlc& plc) { plc.set_bit(120, plc.any_strobe()); }

bool ScriptedPlc::bit(std::uint16_t m) const noexcept {
  return (memory_[m_base + m / 8] >> (m % 8) & std::byte{1}) != std::byte{0};
}

void ScriptedPlc::set_bit(std::uint16_t m, bool on) noexcept {
  const std::byte mask = std::byte{1} << (m % 8);
  std::byte& place = memory_[m_base + m / 8];
  place = on ? place | mask : place & ~mask;
}

std::uint16_t ScriptedPlc::word(std::uint16_t d) const noexcept {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(memory_[d_base + 2U * d]) |
                                    std::to_integer<unsigned>(memory_[d_base + 2U * d + 1]) << 8U);
}

void ScriptedPlc::set_word(std::uint16_t d, std::uint16_t value) noexcept {
  memory_[d_base + 2U * d] = static_cast<std::byte>(value & 0xFFU);
  memory_[d_base + 2U * d + 1] = static_cast<std::byte>(value >> 8U);
}

bool ScriptedPlc::any_strobe() const noexcept { return bit(100) || bit(101) || bit(102); }

tl::expected<std::size_t, protocol::PortError> ScriptedPlc::write(std::span<const std::byte> bytes) noexcept {
  ++requests_;
  if (silent_from_request != 0 && requests_ >= silent_from_request) return bytes.size();
  if (bytes.size() == 1) {
    answer_.assign(1, protocol::fx::ack);
  } else if (const auto request = protocol::fx::decode_request(bytes)) {
    execute(*request);
  } else {
    answer_.assign(1, protocol::fx::nak);
  }
  scan(*this);
  return bytes.size();
}

void ScriptedPlc::note(std::string change) {
  log.push_back(std::move(change));
  times.push_back(std::chrono::steady_clock::now());
}

void ScriptedPlc::execute(const protocol::fx::Request& request) {
  using protocol::fx::Command;
  answer_.assign(1, protocol::fx::ack);
  const auto place = memory_.begin() + request.address;
  switch (request.command) {
    case Command::read: {
      if (request.address == status_address) ++polls;
      const auto reply = protocol::fx::encode_data_reply({&*place, request.count_bytes});
      answer_.assign(reply.begin(), reply.end());
      break;
    }
    case Command::write:
      std::copy(request.data.begin(), request.data.end(), place);
      if (request.address == d_base + 200) {
        note(request.data.size() == 2 ? fmt::format("D100 = {}", word(100))
                                      : fmt::format("D100 = {} {} {}", word(100), word(101), word(102)));
      } else if (request.address == strobe_address) {
        note(fmt::format("M96 byte {:02X}", std::to_integer<unsigned>(request.data.front())));
      } else {
        note("unknown write");
      }
      break;
    case Command::force_on:
    case Command::force_off: {
      const auto m = static_cast<std::uint16_t>(request.address < special_m_force_base
                                                    ? request.address - m_force_base
                                                    : request.address - special_m_force_base + 8000);
      const bool on = request.command == Command::force_on;
      set_bit(m, on);
      note(fmt::format("M{} {}", m, on ? "on" : "off"));
      break;
    }
    default:
      answer_.assign(1, protocol::fx::nak);
  }
}

tl::expected<std::size_t, protocol::PortError> ScriptedPlc::read(std::span<std::byte> into) noexcept {
  const std::size_t count = std::min(answer_.size(), into.size());
  std::copy_n(answer_.begin(), count, into.begin());
  answer_.clear();
  return count;
}

}  // namespace kernel_mocks
