// Where the devices lie. Expected addresses come from the tables and worked examples of the sources; the
// sweep over all devices checks that the map is one to one.
#include "protocol/fx/address_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <tuple>
#include <vector>

namespace protocol::fx {
namespace {

using enum DeviceKind;
constexpr auto legacy = AddressSpace::legacy;
constexpr auto wide = AddressSpace::wide;
constexpr Model all_models[] = {Model::fx1s, Model::fx1n, Model::fx2n, Model::fx3u};
constexpr DeviceKind all_kinds[] = {x, y, m, s, t_contact, c_contact, t_value, c_value, d};

Device device(std::string_view name, Model model) {
  const auto parsed = parse_device(name, model);
  EXPECT_TRUE(parsed.has_value()) << name;
  return parsed.value_or(Device{});
}

struct Place {
  const char* name;
  unsigned byte;
  int bit = -1;  ///< bit number, -1 for words
};

void expect_places(Model model, AddressSpace space, std::initializer_list<Place> places) {
  for (const Place& place : places) {
    SCOPED_TRACE(place.name);
    const Device wanted = device(place.name, model);
    EXPECT_EQ(byte_address(wanted, model, space), place.byte);
    if (place.bit < 0) {
      EXPECT_EQ(bit_number(wanted, model, space), std::nullopt);
    } else {
      EXPECT_EQ(bit_number(wanted, model, space), place.bit);
      EXPECT_EQ(locate_bit(static_cast<std::uint16_t>(place.bit), model, space), wanted);
    }
  }
}

TEST(FxAddressMap, legacy_space_of_fx1n_as_the_sources_have_it) {
  expect_places(Model::fx1n, legacy, {{"S0", 0x0000, 0x0000},    {"S999", 0x007C, 0x03E7},
                                      {"X0", 0x0080, 0x0400},    {"X17", 0x0081, 0x040F},
                                      {"X177", 0x008F, 0x047F},  {"Y0", 0x00A0, 0x0500},
                                      {"Y20", 0x00A2, 0x0510},   {"TS10", 0x00C1, 0x060A},
                                      {"TS255", 0x00DF, 0x06FF}, {"M100", 0x010C, 0x0864},
                                      {"M1023", 0x017F, 0x0BFF}, {"M1535", 0x01BF, 0x0DFF},
                                      {"CS0", 0x01C0, 0x0E00},   {"CS255", 0x01DF, 0x0EFF},
                                      {"M8000", 0x01E0, 0x0F00}, {"M8037", 0x01E4, 0x0F25},
                                      {"M8255", 0x01FF, 0x0FFF}, {"TN10", 0x0814},
                                      {"TN255", 0x09FE},         {"CN0", 0x0A00},
                                      {"CN199", 0x0B8E},         {"CN200", 0x0C00},
                                      {"CN255", 0x0CDC},         {"D8000", 0x0E00},
                                      {"D8001", 0x0E02},         {"D8101", 0x0ECA},
                                      {"D8255", 0x0FFE},         {"D0", 0x1000},
                                      {"D123", 0x10F6},          {"D511", 0x13FE},
                                      {"D7999", 0x4E7E}});
}

TEST(FxAddressMap, wide_space_of_fx3u_as_the_sources_have_it) {
  expect_places(Model::fx3u, wide, {{"D0", 0x4000},
                                    {"D100", 0x40C8},
                                    {"D7999", 0x7E7E},
                                    {"D8000", 0x8000},
                                    {"D8127", 0x80FE},
                                    {"D8511", 0x83FE},
                                    {"TN0", 0x1000},
                                    {"TN511", 0x13FE},
                                    {"CN0", 0x0A00},
                                    {"CN200", 0x0C00},
                                    {"M0", 0x8800, 0x4000},
                                    {"M7679", 0x8BBF, 0x5DFF},
                                    {"Y0", 0x8BC0, 0x5E00},
                                    {"Y377", 0x8BDF, 0x5EFF},
                                    {"M8000", 0x8C00, 0x6000},
                                    {"M8511", 0x8C3F, 0x61FF},
                                    {"X0", 0x8CA0, 0x6500},
                                    {"X377", 0x8CBF, 0x65FF},
                                    {"S0", 0x8CE0, 0x6700},
                                    {"S4095", 0x8EDF, 0x76FF},
                                    {"CS0", 0x9340, 0x9A00},
                                    {"TS0", 0x9360, 0x9B00},
                                    {"TS511", 0x939F, 0x9CFF}});
}

TEST(FxAddressMap, wide_space_of_fx1n_and_fx2n_as_the_sources_have_it) {
  for (const Model model : {Model::fx1n, Model::fx2n})
    expect_places(model, wide,
                  {{"M0", 0x0000, 0x0000},
                   {"Y0", 0x0180, 0x0C00},
                   {"M8000", 0x01C0, 0x0E00},
                   {"M8118", 0x01CE, 0x0E76},
                   {"X0", 0x0240, 0x1200},
                   {"D8003", 0x0E06},
                   {"TN0", 0x1000},
                   {"CN0", 0x0A00}});
  expect_places(Model::fx2n, wide, {{"M3071", 0x017F, 0x0BFF}});
}

TEST(FxAddressMap, fx1s_has_no_wide_space) {
  for (unsigned address = 0; address <= 0xFFFF; ++address) {
    EXPECT_EQ(locate_byte(static_cast<std::uint16_t>(address), Model::fx1s, wide), std::nullopt);
    EXPECT_EQ(locate_bit(static_cast<std::uint16_t>(address), Model::fx1s, wide), std::nullopt);
  }
}

TEST(FxAddressMap, octal_numbers_beyond_77_are_true_octal) {
  EXPECT_EQ(byte_address(device("X100", Model::fx3u), Model::fx3u, legacy), 0x0088);
}

TEST(FxAddressMap, devices_above_the_legacy_ranges_are_shown_in_the_wide_space_only) {
  for (const auto* name : {"M1536", "S1000", "TS256", "TN256", "M8256", "D8256"}) {
    const Device wanted = device(name, Model::fx3u);
    EXPECT_EQ(byte_address(wanted, Model::fx3u, legacy), std::nullopt) << name;
    EXPECT_TRUE(byte_address(wanted, Model::fx3u, wide).has_value()) << name;
  }
}

TEST(FxAddressMap, coil_images_and_unused_numbers_hold_no_device) {
  for (const unsigned address : {0x007D, 0x00E0, 0x00FF, 0x0200, 0x02A0, 0x02C0, 0x0300, 0x03C0, 0x04C0,
                                 0x05C0, 0x07FF, 0x0B90, 0x0CE0, 0x4E80, 0x8000, 0x805C, 0xFFFF})
    EXPECT_EQ(locate_byte(static_cast<std::uint16_t>(address), Model::fx3u, legacy), std::nullopt) << address;
  for (const unsigned bit : {0x03E8, 0x0700, 0x07FF, 0x1000, 0x1500, 0x7000, 0x8000})
    EXPECT_EQ(locate_bit(static_cast<std::uint16_t>(bit), Model::fx3u, legacy), std::nullopt) << bit;
  for (const unsigned address : {0x0000, 0x7E80, 0x92E0, 0x9300, 0x93A0})
    EXPECT_EQ(locate_byte(static_cast<std::uint16_t>(address), Model::fx3u, wide), std::nullopt) << address;
}

TEST(FxAddressMap, a_byte_tells_which_part_of_a_word_it_is) {
  EXPECT_EQ(locate_byte(0x10F7, Model::fx1n, legacy), (ByteLocation{{d, 123}, 1, 1}));
  EXPECT_EQ(locate_byte(0x0C07, Model::fx1n, legacy), (ByteLocation{{c_value, 201}, 3, 1}));
}

TEST(FxAddressMap, a_byte_tells_how_many_of_its_bits_exist) {
  EXPECT_EQ(locate_byte(0x00A0, Model::fx1s, legacy), (ByteLocation{{y, 0}, 0, 8}));
  EXPECT_EQ(locate_byte(0x00A1, Model::fx1s, legacy), (ByteLocation{{y, 8}, 0, 6}));
  EXPECT_EQ(locate_byte(0x00A2, Model::fx1s, legacy), std::nullopt);
}

TEST(FxAddressMap, the_byte_in_which_the_counters_of_fx1s_begin_again_is_named_after_its_bit_0) {
  EXPECT_EQ(locate_byte(0x01DD, Model::fx1s, legacy), (ByteLocation{{c_contact, 232}, 0, 5}));
  EXPECT_EQ(locate_bit(0x0EEA, Model::fx1s, legacy), std::nullopt);
  EXPECT_EQ(locate_bit(0x0EEB, Model::fx1s, legacy), (Device{c_contact, 235}));
}

/// Every device of a model: found by asking for each number there can be.
std::vector<Device> devices_of(Model model) {
  std::vector<Device> devices;
  for (const DeviceKind kind : all_kinds)
    for (unsigned number = 0; number <= 0xFFFF; ++number)
      if (const Device candidate{kind, static_cast<std::uint16_t>(number)}; exists(candidate, model))
        devices.push_back(candidate);
  return devices;
}

TEST(FxAddressMap, every_device_lies_at_one_address_of_some_space_and_is_found_there_again) {
  for (const Model model : all_models) {
    for (const Device wanted : devices_of(model)) {
      bool shown = false;
      for (const AddressSpace space : {legacy, wide}) {
        const auto address = byte_address(wanted, model, space);
        if (!address) continue;
        shown = true;
        for (unsigned part = 0; part < (width_bits(wanted) + 7) / 8; ++part) {
          const auto found = locate_byte(static_cast<std::uint16_t>(*address + part), model, space);
          ASSERT_TRUE(found.has_value()) << to_string(wanted);
          if (width_bits(wanted) == 1) {
            ASSERT_EQ(found->device.number / 8, wanted.number / 8) << to_string(wanted);
          } else {
            ASSERT_EQ(*found, (ByteLocation{wanted, static_cast<std::uint8_t>(part), 1}))
                << to_string(wanted);
          }
          ASSERT_EQ(found->device.kind, wanted.kind);
        }
        const auto bit = bit_number(wanted, model, space);
        ASSERT_EQ(bit.has_value(), width_bits(wanted) == 1) << to_string(wanted);
        if (bit) {
          ASSERT_EQ(locate_bit(*bit, model, space), wanted);
          ASSERT_EQ(*bit, 8U * (*address % 0x8000U) + wanted.number % 8U);
        }
      }
      EXPECT_TRUE(shown) << to_string(model) << " " << to_string(wanted);
    }
  }
}

TEST(FxAddressMap, no_two_devices_overlap_and_no_device_is_found_where_none_was_placed) {
  for (const Model model : all_models) {
    const auto devices = devices_of(model);
    for (const AddressSpace space : {legacy, wide}) {
      std::map<unsigned, Device> owner;  // by bit position in the whole space
      for (const Device wanted : devices) {
        const auto address = byte_address(wanted, model, space);
        if (!address) continue;
        const unsigned width = width_bits(wanted);
        const unsigned first = 8U * *address + (width == 1 ? wanted.number % 8U : 0U);
        for (unsigned i = 0; i < width; ++i) {
          const auto [other, fresh] = owner.emplace(first + i, wanted);
          ASSERT_TRUE(fresh) << to_string(wanted) << " overlaps " << to_string(other->second);
        }
      }
      for (unsigned address = 0; address <= 0xFFFF; ++address) {
        bool taken = false;
        for (unsigned i = 0; i < 8; ++i) taken = taken || owner.count(8U * address + i) != 0;
        ASSERT_EQ(locate_byte(static_cast<std::uint16_t>(address), model, space).has_value(), taken)
            << address;
      }
    }
  }
}

}  // namespace
}  // namespace protocol::fx
