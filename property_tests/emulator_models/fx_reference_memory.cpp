#include "property_tests/emulator_models/fx_reference_memory.hpp"

#include <algorithm>
#include <span>

namespace property_tests {
namespace {

using protocol::fx::Command;
using protocol::fx::Model;
using protocol::fx::Request;

/// As the tables stand in the protocol's description.
struct Row {
  char kind;
  unsigned first_number;
  unsigned end_number;
  unsigned address;
  unsigned bits;
};

const std::vector<Row> legacy{
    {'S', 0, 1000, 0x0000, 1},    {'X', 0, 256, 0x0080, 1},      {'Y', 0, 256, 0x00A0, 1},
    {'t', 0, 256, 0x00C0, 1},     {'M', 0, 1536, 0x0100, 1},     {'c', 0, 256, 0x01C0, 1},
    {'M', 8000, 8256, 0x01E0, 1}, {'T', 0, 256, 0x0800, 16},     {'C', 0, 200, 0x0A00, 16},
    {'C', 200, 256, 0x0C00, 32},  {'D', 8000, 8256, 0x0E00, 16}, {'D', 0, 8000, 0x1000, 16}};
const std::vector<Row> wide_fx2n{{'M', 0, 3072, 0x0000, 1},     {'Y', 0, 256, 0x0180, 1},
                                 {'M', 8000, 8256, 0x01C0, 1},  {'X', 0, 256, 0x0240, 1},
                                 {'C', 0, 200, 0x0A00, 16},     {'C', 200, 256, 0x0C00, 32},
                                 {'D', 8000, 8256, 0x0E00, 16}, {'T', 0, 256, 0x1000, 16}};
const std::vector<Row> wide_fx3u{
    {'C', 0, 200, 0x0A00, 16},  {'C', 200, 256, 0x0C00, 32},   {'T', 0, 512, 0x1000, 16},
    {'D', 0, 8000, 0x4000, 16}, {'D', 8000, 8512, 0x8000, 16}, {'M', 0, 7680, 0x8800, 1},
    {'Y', 0, 256, 0x8BC0, 1},   {'M', 8000, 8512, 0x8C00, 1},  {'X', 0, 256, 0x8CA0, 1},
    {'S', 0, 4096, 0x8CE0, 1},  {'c', 0, 256, 0x9340, 1},      {'t', 0, 512, 0x9360, 1}};

const std::vector<Row>& rows_of(Model model, bool wide) {
  static const std::vector<Row> none;
  if (!wide) return legacy;
  return model == Model::fx1s ? none : model == Model::fx3u ? wide_fx3u : wide_fx2n;
}

/// How many devices of a kind the manuals give a model: {plain, special}.
std::pair<unsigned, unsigned> counts(char kind, Model model) {
  const auto of = [&](unsigned fx1s, unsigned fx1n, unsigned fx2n, unsigned fx3u) {
    return model == Model::fx1s ? fx1s : model == Model::fx1n ? fx1n : model == Model::fx2n ? fx2n : fx3u;
  };
  const unsigned special = of(256, 256, 256, 512);
  switch (kind) {
    case 'X':
      return {of(16, 128, 184, 256), 0};
    case 'Y':
      return {of(14, 128, 184, 256), 0};
    case 'M':
      return {of(512, 1536, 3072, 7680), special};
    case 'S':
      return {of(128, 1000, 1000, 4096), 0};
    case 't':
    case 'T':
      return {of(64, 256, 256, 512), 0};
    case 'D':
      return {of(256, 8000, 8000, 8000), special};
    default:
      return {256, 0};
  }
}

bool has(Model model, FxReferenceMemory::Name name) {
  const auto [kind, number] = name;
  const auto [plain, special] = counts(kind, model);
  if (model == Model::fx1s && (kind == 'c' || kind == 'C') && number >= 32 && number < 235) return false;
  return number < plain || (number >= 8000 && number < 8000 + special);
}

bool only_the_plc_writes(Model model, FxReferenceMemory::Name name) {
  const auto [kind, number] = name;
  const auto within = [&](unsigned first, unsigned last) { return number >= first && number <= last; };
  if (kind == 'M') return within(8000, 8003) || within(8011, 8014);
  if (kind == 'D') return number == 8001 || within(8010, 8019) || (number == 8101 && model == Model::fx3u);
  return false;
}

/// One bit of the address space: which device, and which of its bits.
struct Place {
  FxReferenceMemory::Name name;
  unsigned bit;
};

std::optional<Place> place_of_bit(Model model, bool wide, unsigned address, unsigned bit) {
  for (const Row& row : rows_of(model, wide)) {
    const unsigned end = row.address + ((row.end_number - row.first_number) * row.bits + 7) / 8;
    if (address < row.address || address >= end) continue;
    const unsigned offset = (address - row.address) * 8 + bit;
    const FxReferenceMemory::Name name{row.kind, row.first_number + offset / row.bits};
    if (name.second >= row.end_number || !has(model, name)) return std::nullopt;
    return Place{name, offset % row.bits};
  }
  return std::nullopt;
}

std::vector<Place> places_of_byte(Model model, bool wide, unsigned address) {
  std::vector<Place> places;
  for (unsigned bit = 0; bit < 8; ++bit) {
    if (const auto place = place_of_bit(model, wide, address, bit)) places.push_back(*place);
  }
  return places;
}

constexpr const char* ack = "\x06";
constexpr const char* nak = "\x15";
constexpr unsigned bad_command = 6205;

}  // namespace

FxReferenceMemory::FxReferenceMemory(Model fx_model) : model{fx_model} {
  values[{'D', 8000}] = 200;
  values[{'D', 8001}] = model == Model::fx1s ? 22210 : model == Model::fx1n ? 26210 : 24241;
  if (model == Model::fx3u) values[{'D', 8101}] = 16241;
  values[{'M', 8001}] = 1;
  values[{'M', 8003}] = 1;
}

std::string FxReferenceMemory::refuse(unsigned trouble) {
  values[{'M', 8062}] = 1;
  values[{'D', 8062}] = trouble;
  return nak;
}

std::string FxReferenceMemory::answer(const Request& request) {
  const bool wide = request.command >= Command::read_wide;
  const auto write_bit = [this](const Place& place, bool on) {
    unsigned& value = values[place.name];
    value = (value & ~(1U << place.bit)) | (on ? 1U << place.bit : 0U);
  };
  if (request.command != Command::read && request.command != Command::read_wide &&
      request.command != Command::write && request.command != Command::write_wide) {
    const unsigned beyond = wide ? 0x8000 : 0;  // where an FX3U has its bits
    auto place = place_of_bit(model, wide, request.address / 8U, request.address % 8U);
    if (beyond != 0 && model == Model::fx3u)
      place = place_of_bit(model, wide, beyond + request.address / 8U, request.address % 8U);
    if (!place || place->name.first == 'T' || place->name.first == 'C' || place->name.first == 'D' ||
        only_the_plc_writes(model, place->name))
      return refuse(bad_command);
    write_bit(*place, request.command == Command::force_on || request.command == Command::force_on_wide);
    return ack;
  }
  const bool writes = request.command == Command::write || request.command == Command::write_wide;
  std::vector<std::vector<Place>> bytes;
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    const unsigned address = request.address + i;
    bytes.push_back(address > 0xFFFF ? std::vector<Place>{} : places_of_byte(model, wide, address));
    const bool forbidden = std::ranges::any_of(
        bytes.back(), [&](const Place& place) { return writes && only_the_plc_writes(model, place.name); });
    if (bytes.back().empty() || forbidden) return refuse(bad_command);
  }
  std::string data;
  for (unsigned i = 0; i < request.count_bytes; ++i) {
    unsigned shown = 0;
    for (const Place& place : bytes[i]) {
      // The place within the byte: of words their bits, of bit devices the number's lowest digits.
      const bool is_word = place.name.first == 'T' || place.name.first == 'C' || place.name.first == 'D';
      const unsigned at = is_word ? place.bit % 8 : place.name.second % 8;
      if (writes)
        write_bit(place, (std::to_integer<unsigned>(request.data[i]) >> at & 1U) != 0);
      else
        shown |= (values[place.name] >> place.bit & 1U) << at;
    }
    data += static_cast<char>(shown);
  }
  if (writes) return ack;
  const auto frame = protocol::fx::encode_data_reply(std::as_bytes(std::span{data}));
  return {reinterpret_cast<const char*>(frame.data()), frame.size()};
}

std::vector<FxAddressRange> fx_address_ranges(Model model, bool wide) {
  std::vector<FxAddressRange> ranges;
  for (const Row& row : rows_of(model, wide))
    ranges.push_back({row.address, row.address + ((row.end_number - row.first_number) * row.bits + 7) / 8});
  return ranges;
}

}  // namespace property_tests
