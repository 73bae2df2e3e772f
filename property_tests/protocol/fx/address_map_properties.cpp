// The address map, device by device and address by address: not samples but all of them.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "protocol/fx/address_map.hpp"

namespace property_tests {
namespace {

using namespace protocol::fx;
using enum DeviceKind;

constexpr DeviceKind kinds[] = {x, y, m, s, t_contact, c_contact, t_value, c_value, d};
constexpr unsigned numbers_count = 0x10000;

std::vector<Device> devices_of(Model model) {
  std::vector<Device> devices;
  for (const DeviceKind kind : kinds) {
    for (unsigned number = 0; number < numbers_count; ++number) {
      const Device device{kind, static_cast<std::uint16_t>(number)};
      if (exists(device, model)) devices.push_back(device);
    }
  }
  return devices;
}

using MapOf = std::tuple<Model, AddressSpace>;

class AddressMapOf : public testing::TestWithParam<MapOf> {
 protected:
  Model model = std::get<0>(GetParam());
  AddressSpace space = std::get<1>(GetParam());
};

TEST_P(AddressMapOf, every_device_has_one_place_that_leads_back_to_it_and_no_two_overlap) {
  std::vector<std::string> owners(8 * numbers_count);  // by bit of the address space
  for (const Device device : devices_of(model)) {
    const auto byte = byte_address(device, model, space);
    const auto bit = bit_number(device, model, space);
    const unsigned width = width_bits(device);
    if (!byte) {
      EXPECT_FALSE(bit) << to_string(device);
      continue;
    }
    ASSERT_EQ(bit.has_value(), width == 1) << to_string(device);
    const std::size_t first_bit = 8U * *byte + (width == 1 ? *bit % 8U : 0U);
    for (std::size_t i = first_bit; i < first_bit + width; ++i) {
      ASSERT_LT(i, owners.size()) << to_string(device);
      ASSERT_EQ(owners[i], "") << to_string(device) << " lies on it";
      owners[i] = to_string(device);
    }
    if (width == 1) {
      EXPECT_EQ(*bit / 8U, *byte % 0x8000U) << to_string(device);
      EXPECT_EQ(locate_bit(*bit, model, space), device) << to_string(device);
      const auto place = locate_byte(*byte, model, space);
      ASSERT_TRUE(place) << to_string(device);
      EXPECT_EQ(place->device, (Device{device.kind, static_cast<std::uint16_t>(device.number - *bit % 8U)}));
    } else {
      for (unsigned i = 0; i < width / 8; ++i) {
        EXPECT_EQ(locate_byte(static_cast<std::uint16_t>(*byte + i), model, space),
                  (ByteLocation{device, static_cast<std::uint8_t>(i), 1}))
            << to_string(device);
      }
    }
  }
}

TEST_P(AddressMapOf, every_address_shows_what_has_its_place_there_and_nothing_else) {
  std::map<unsigned, unsigned> bits_at;  // devices' bits, by byte address
  std::map<unsigned, Device> device_of_bit;
  for (const Device device : devices_of(model)) {
    const auto byte = byte_address(device, model, space);
    if (!byte) continue;
    if (const auto bit = bit_number(device, model, space)) {
      ++bits_at[*byte];
      EXPECT_TRUE(device_of_bit.emplace(*bit, device).second) << to_string(device);
    } else {
      for (unsigned i = 0; i < width_bits(device) / 8; ++i) bits_at[*byte + i] = 1;
    }
  }
  for (unsigned address = 0; address < numbers_count; ++address) {
    const auto place = locate_byte(static_cast<std::uint16_t>(address), model, space);
    const auto expected = bits_at.find(address);
    ASSERT_EQ(place.has_value(), expected != bits_at.end()) << std::hex << address;
    if (place) {
      EXPECT_EQ(place->devices_count, expected->second) << std::hex << address;
    }
    const auto device = locate_bit(static_cast<std::uint16_t>(address), model, space);
    const auto expected_device = device_of_bit.find(address);
    ASSERT_EQ(device.has_value(), expected_device != device_of_bit.end()) << std::hex << address;
    if (device) {
      EXPECT_EQ(*device, expected_device->second) << std::hex << address;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, AddressMapOf,
                         testing::Combine(testing::Values(Model::fx1s, Model::fx1n, Model::fx2n, Model::fx3u),
                                          testing::Values(AddressSpace::legacy, AddressSpace::wide)),
                         [](const auto& tested) {
                           return std::string{to_string(std::get<0>(tested.param))} +
                                  (std::get<1>(tested.param) == AddressSpace::wide ? "_wide" : "_legacy");
                         });

TEST(FxDeviceNames, every_device_has_a_name_that_leads_back_to_it) {
  for (const Model model : {Model::fx1s, Model::fx1n, Model::fx2n, Model::fx3u}) {
    for (const Device device : devices_of(model)) {
      ASSERT_EQ(parse_device(to_string(device), model), device) << to_string(device);
      ASSERT_EQ(parse_model(to_string(model)), model);
    }
  }
}

}  // namespace
}  // namespace property_tests
