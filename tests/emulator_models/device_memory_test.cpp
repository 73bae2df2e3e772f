// The memory of a PLC: values by device, bytes by address.
#include "emulator_models/device_memory.hpp"

#include <gtest/gtest.h>

namespace emulator_models {
namespace {

using protocol::fx::AddressSpace;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::Model;

constexpr Device d(std::uint16_t number) { return {DeviceKind::d, number}; }
constexpr Device m(std::uint16_t number) { return {DeviceKind::m, number}; }
constexpr Device y(std::uint16_t index) { return {DeviceKind::y, index}; }
constexpr Device c(std::uint16_t number) { return {DeviceKind::c_value, number}; }

TEST(DeviceMemory, is_all_zero_at_first) {
  const DeviceMemory memory{Model::fx3u};
  EXPECT_EQ(memory.get(d(0)), 0U);
  EXPECT_EQ(memory.get(m(8511)), 0U);
}

TEST(DeviceMemory, keeps_what_fits_the_width_of_a_device) {
  DeviceMemory memory{Model::fx3u};
  memory.set(d(7), 0x1'2345);
  memory.set(c(199), 0x1'2345);
  memory.set(c(200), 0xDEAD'BEEF);
  memory.set(m(0), 2);
  EXPECT_EQ(memory.get(d(7)), 0x2345U);
  EXPECT_EQ(memory.get(c(199)), 0x2345U);
  EXPECT_EQ(memory.get(c(200)), 0xDEAD'BEEFU);
  EXPECT_EQ(memory.get(m(0)), 1U);
}

TEST(DeviceMemory, plain_and_special_devices_of_a_kind_are_different_ones) {
  DeviceMemory memory{Model::fx1s};
  memory.set(d(255), 1);
  memory.set(d(8000), 2);
  EXPECT_EQ(memory.get(d(255)), 1U);
  EXPECT_EQ(memory.get(d(8000)), 2U);
}

TEST(DeviceMemory, words_lie_low_byte_first_and_bits_lowest_number_first) {
  DeviceMemory memory{Model::fx1n};
  memory.set(d(123), 0x1234);
  memory.set(y(0), 1);
  memory.set(y(7), 1);
  EXPECT_EQ(memory.read_byte(0x10F6, AddressSpace::legacy), std::byte{0x34});
  EXPECT_EQ(memory.read_byte(0x10F7, AddressSpace::legacy), std::byte{0x12});
  EXPECT_EQ(memory.read_byte(0x00A0, AddressSpace::legacy), std::byte{0x81});
}

TEST(DeviceMemory, a_written_byte_changes_its_part_of_a_word_only) {
  DeviceMemory memory{Model::fx1n};
  memory.set(c(200), 0x1122'3344);
  EXPECT_TRUE(memory.write_byte(0x0C02, AddressSpace::legacy, std::byte{0xAB}));
  EXPECT_EQ(memory.get(c(200)), 0x11AB'3344U);
}

TEST(DeviceMemory, both_spaces_show_one_memory) {
  DeviceMemory memory{Model::fx3u};
  EXPECT_TRUE(memory.write_byte(0x4000, AddressSpace::wide, std::byte{0x5A}));
  EXPECT_EQ(memory.read_byte(0x1000, AddressSpace::legacy), std::byte{0x5A});
}

TEST(DeviceMemory, bits_that_the_model_has_not_read_as_zero_and_ignore_a_write) {
  DeviceMemory memory{Model::fx1s};  // Y0 to Y15: six bits in the second byte
  EXPECT_TRUE(memory.write_byte(0x00A1, AddressSpace::legacy, std::byte{0xFF}));
  EXPECT_EQ(memory.read_byte(0x00A1, AddressSpace::legacy), std::byte{0x3F});
}

TEST(DeviceMemory, the_counters_of_fx1s_go_on_after_their_gap) {
  DeviceMemory memory{Model::fx1s};
  EXPECT_TRUE(memory.write_byte(0x01DD, AddressSpace::legacy, std::byte{0xFF}));
  EXPECT_EQ(memory.read_byte(0x01DD, AddressSpace::legacy), std::byte{0xF8});  // C235 to C239
  EXPECT_EQ(memory.get({DeviceKind::c_contact, 235}), 1U);
}

TEST(DeviceMemory, nothing_is_read_or_written_where_no_device_lies) {
  DeviceMemory memory{Model::fx1s};
  EXPECT_EQ(memory.read_byte(0x1200, AddressSpace::legacy), std::nullopt);
  EXPECT_FALSE(memory.write_byte(0x1200, AddressSpace::legacy, std::byte{1}));
}

TEST(DeviceMemory, differences_names_each_device_that_differs) {
  DeviceMemory before{Model::fx3u};
  DeviceMemory after = before;
  EXPECT_TRUE(after.differences(before).empty());
  after.set(d(8511), 1);
  after.set(y(255), 1);
  after.set(d(0), 1);
  EXPECT_EQ(after.differences(before), (std::vector{y(255), d(0), d(8511)}));
}

TEST(DeviceMemory, lies_packed_as_the_port_shows_it_so_that_images_are_parts_of_it) {
  DeviceMemory memory{Model::fx3u};
  memory.set({DeviceKind::x, 9}, 1);
  memory.set(y(255), 1);
  EXPECT_EQ(memory.inputs().size(), 32U);
  EXPECT_EQ(memory.inputs()[1], std::byte{0x02});
  EXPECT_EQ(memory.outputs()[31], std::byte{0x80});
  memory.bytes()[memory.place_of(d(8000)).byte_index] = std::byte{0x96};
  EXPECT_EQ(memory.get(d(8000)), 150U);
  EXPECT_EQ(memory.place_of(d(101)).byte_index, memory.place_of(d(100)).byte_index + 2);
  EXPECT_EQ(memory.place_of(c(201)).byte_index, memory.place_of(c(200)).byte_index + 4);
  EXPECT_EQ(memory.place_of(m(8005)).bit_index, 5U);
}

TEST(DeviceMemory, a_cleared_range_has_sharp_ends) {
  DeviceMemory memory{Model::fx3u};
  for (const Device relay : {m(99), m(100), m(102), m(103)}) memory.set(relay, 1);
  memory.clear(DeviceKind::m, 100, 3);
  EXPECT_EQ(memory.get(m(99)), 1U);
  EXPECT_EQ(memory.get(m(100)), 0U);
  EXPECT_EQ(memory.get(m(102)), 0U);
  EXPECT_EQ(memory.get(m(103)), 1U);
}

TEST(DeviceMemoryDeathTest, asking_for_a_device_that_the_model_has_not_is_a_mistake_of_the_caller) {
  const DeviceMemory memory{Model::fx1s};
  EXPECT_DEATH((void)memory.get(d(256)), "check failed");
}

}  // namespace
}  // namespace emulator_models
