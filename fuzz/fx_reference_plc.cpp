#include "fuzz/fx_reference_plc.hpp"

#include <bit>
#include <cstring>

namespace fuzz {

using protocol::fx::FrameError;
using protocol::fx::Model;

namespace {

const std::string ack = "\x06";
const std::string nak = "\x15";

constexpr unsigned bad_character = 6202;
constexpr unsigned bad_sum = 6203;
constexpr unsigned bad_format = 6204;
constexpr unsigned bad_command = 6205;

}  // namespace

std::size_t ones_in(std::span<const std::byte> bytes) noexcept {
  std::size_t count = 0;
  for (; bytes.size() >= sizeof(std::uint64_t); bytes = bytes.subspan(sizeof(std::uint64_t))) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, bytes.data(), sizeof eight);
    count += static_cast<std::size_t>(std::popcount(eight));
  }
  for (const std::byte byte : bytes)
    count += static_cast<std::size_t>(std::popcount(std::to_integer<unsigned>(byte)));
  return count;
}

/// So many devices of a kind from an address on.
struct ReferencePlc::Row {
  unsigned address;
  Kind kind;
  unsigned devices;
};

ReferencePlc::ReferencePlc(Model model) : model_{model} {
  set_word(special_d, 0, 200);
  set_word(special_d, 1, model == Model::fx1s ? 22210 : model == Model::fx1n ? 26210 : 24241);
  if (model == Model::fx3u) set_word(special_d, 101, 16241);
  set_run_flags(false);
}

std::optional<ReferencePlc::Place> ReferencePlc::place_of(unsigned address, bool is_wide) const {
  static constexpr Row legacy[] = {
      {0x0000, s, 1000},        {0x0080, x, 256},        {0x00A0, y, 256},         {0x00C0, t, 256},
      {0x0100, m, 1536},        {0x01C0, c, 256},        {0x01E0, special_m, 256}, {0x0800, t_value, 256},
      {0x0A00, c16_value, 200}, {0x0C00, c32_value, 56}, {0x0E00, special_d, 256}, {0x1000, d, 8000}};
  static constexpr Row wide_fx1n[] = {
      {0x0000, m, 3072},        {0x0180, y, 256},        {0x01C0, special_m, 256}, {0x0240, x, 256},
      {0x0A00, c16_value, 200}, {0x0C00, c32_value, 56}, {0x0E00, special_d, 256}, {0x1000, t_value, 256}};
  static constexpr Row wide_fx3u[] = {
      {0x0A00, c16_value, 200}, {0x0C00, c32_value, 56}, {0x1000, t_value, 512}, {0x4000, d, 8000},
      {0x8000, special_d, 512}, {0x8800, m, 7680},       {0x8BC0, y, 256},       {0x8C00, special_m, 512},
      {0x8CA0, x, 256},         {0x8CE0, s, 4096},       {0x9340, c, 256},       {0x9360, t, 512}};
  std::span<const Row> rows = legacy;
  if (is_wide) {
    if (model_ == Model::fx1s) return std::nullopt;
    rows = model_ == Model::fx3u ? std::span<const Row>{wide_fx3u} : std::span<const Row>{wide_fx1n};
  }
  for (const Row& row : rows) {
    const unsigned size = is_bit(row.kind) ? row.devices / 8 : row.devices * (row.kind == c32_value ? 4 : 2);
    if (address < row.address || address >= row.address + size) continue;
    const unsigned index = address - row.address;
    const std::uint8_t existing = existing_of(row.kind, index);
    if (existing == 0) return std::nullopt;
    return Place{row.kind, index, existing};
  }
  return std::nullopt;
}

unsigned ReferencePlc::devices_of(Kind kind) const {
  // In the order FX1S, FX1N, FX2N, FX3U.
  struct Counts {
    unsigned of[4];
  };
  static constexpr Counts table[kinds_count] = {
      {{16, 128, 184, 256}},      // X
      {{14, 128, 184, 256}},      // Y
      {{512, 1536, 3072, 7680}},  // M
      {{256, 256, 256, 512}},     // M8000
      {{128, 1000, 1000, 4096}},  // S
      {{64, 256, 256, 512}},      // T
      {{256, 256, 256, 256}},     // C, of FX1S with a gap
      {{64, 256, 256, 512}},      // T value
      {{32, 200, 200, 200}},      // C value, 16 bits
      {{56, 56, 56, 56}},         // C value, 32 bits, of FX1S with a gap
      {{256, 8000, 8000, 8000}},  // D
      {{256, 256, 256, 512}},     // D8000
  };
  return table[kind].of[static_cast<unsigned>(model_)];
}

std::uint8_t ReferencePlc::existing_of(Kind kind, unsigned byte_index) const {
  const unsigned count = devices_of(kind);
  if (!is_bit(kind)) {
    const unsigned index = byte_index / (kind == c32_value ? 4 : 2);
    const bool is_in_gap = model_ == Model::fx1s && kind == c32_value && index < 35;  // C200 to C234
    return index < count && !is_in_gap ? 0xFF : 0;
  }
  std::uint8_t bits = 0;
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned number = 8 * byte_index + i;
    const bool is_in_gap = model_ == Model::fx1s && kind == c && number >= 32 && number < 235;
    if (number < count && !is_in_gap) bits |= static_cast<std::uint8_t>(1U << i);
  }
  return bits;
}

std::uint8_t ReferencePlc::read_only_bits(const Place& place) const {
  if (place.kind == special_m) return place.byte_index == 0 ? 0x0F : place.byte_index == 1 ? 0x78 : 0;
  if (place.kind != special_d) return 0;
  const unsigned number = place.byte_index / 2;
  const bool is_read_only =
      number == 1 || (number >= 10 && number <= 19) || (number == 101 && model_ == Model::fx3u);
  return is_read_only ? 0xFF : 0;
}

std::string ReferencePlc::answer(std::string_view message) {
  if (message == "\x05") return ack;
  const ReferenceMessage request = reference_of_request(message);
  if (request.defect) {
    switch (*request.defect) {
      case FrameError::no_frame:
      case FrameError::too_long:
        return {};
      case FrameError::bad_checksum:
        return refuse(bad_sum);
      case FrameError::unknown_command:
        return refuse(bad_command);
      case FrameError::bad_digit:
        return refuse(bad_character);
      case FrameError::bad_length:
      case FrameError::bad_count:
        return refuse(bad_format);
    }
  }
  switch (request.kind) {
    case ReferenceMessage::Kind::read:
      return read(request);
    case ReferenceMessage::Kind::write:
      return write(request);
    case ReferenceMessage::Kind::force:
      return force(request);
  }
  return {};
}

std::string ReferencePlc::read(const ReferenceMessage& request) {
  std::string digits;
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const auto place = place_of(request.address + i, request.is_wide);
    if (!place) return refuse(bad_command);
    digits += hexadecimal(byte_at(place->kind, place->byte_index), 2);
  }
  return framed(digits);
}

std::string ReferencePlc::write(const ReferenceMessage& request) {
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const auto place = place_of(request.address + i, request.is_wide);
    if (!place || read_only_bits(*place) != 0) return refuse(bad_command);
  }
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const Place place = place_of(request.address + i, request.is_wide).value();
    byte_at(place.kind, place.byte_index) =
        static_cast<std::uint8_t>(value_of(request.digits.substr(2 * std::size_t{i}, 2)) & place.existing);
  }
  return ack;
}

std::string ReferencePlc::force(const ReferenceMessage& request) {
  const bool is_above = request.is_wide && model_ == Model::fx3u;
  const auto place = place_of(request.address / 8 + (is_above ? 0x8000U : 0U), request.is_wide);
  const unsigned mask = 1U << (request.address % 8);
  if (!place || !is_bit(place->kind) || (place->existing & mask) == 0 || (read_only_bits(*place) & mask) != 0)
    return refuse(bad_command);
  std::uint8_t& byte = byte_at(place->kind, place->byte_index);
  byte = static_cast<std::uint8_t>(request.is_on ? byte | mask : byte & ~mask);
  return ack;
}

std::string ReferencePlc::refuse(unsigned trouble) {
  set_bit(special_m, 62, true);
  set_word(special_d, 62, trouble);
  return nak;
}

void ReferencePlc::set_bit(Kind kind, unsigned number, bool on) {
  std::uint8_t& byte = byte_at(kind, number / 8);
  const unsigned mask = 1U << (number % 8);
  byte = static_cast<std::uint8_t>(on ? byte | mask : byte & ~mask);
}

bool ReferencePlc::bit(Kind kind, unsigned number) const {
  return (byte_at(kind, number / 8) >> (number % 8) & 1U) != 0;
}

void ReferencePlc::set_word(Kind kind, unsigned number, unsigned value) {
  byte_at(kind, 2 * number) = static_cast<std::uint8_t>(value);
  byte_at(kind, 2 * number + 1) = static_cast<std::uint8_t>(value / 256);
}

unsigned ReferencePlc::word(Kind kind, unsigned number) const {
  return byte_at(kind, 2 * number) + 256U * byte_at(kind, 2 * number + 1);
}

void ReferencePlc::clear(Kind kind, unsigned first, unsigned end) {
  for (unsigned i = first; i < end; ++i) {
    if (is_bit(kind)) {
      set_bit(kind, i, false);
    } else if (kind == c32_value) {
      set_word(kind, 2 * i, 0);
      set_word(kind, 2 * i + 1, 0);
    } else {
      set_word(kind, i, 0);
    }
  }
}

void ReferencePlc::toggle_input(unsigned index) noexcept {
  inputs_[index / 8 % inputs_.size()] ^= static_cast<std::uint8_t>(1U << (index % 8));
}

}  // namespace fuzz
