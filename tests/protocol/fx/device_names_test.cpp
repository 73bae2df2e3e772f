// Names of devices and models, and the ranges of each model.
#include <gtest/gtest.h>

#include <string>

#include "protocol/fx/address_map.hpp"

namespace protocol::fx {
namespace {

using enum DeviceKind;

TEST(FxDeviceName, every_kind_has_its_letters) {
  const struct {
    const char* name;
    Device device;
  } names[] = {{"X17", {x, 15}},           {"Y20", {y, 16}},
               {"M8000", {m, 8000}},       {"S0", {s, 0}},
               {"D123", {d, 123}},         {"TN10", {t_value, 10}},
               {"TS10", {t_contact, 10}},  {"CN200", {c_value, 200}},
               {"CS200", {c_contact, 200}}};
  for (const auto& [name, device] : names) {
    EXPECT_EQ(parse_device(name, Model::fx3u), device) << name;
    EXPECT_EQ(to_string(device), name);
  }
}

TEST(FxDeviceName, case_does_not_matter) {
  EXPECT_EQ(parse_device("tn10", Model::fx3u), (Device{t_value, 10}));
  EXPECT_EQ(parse_device("x7", Model::fx3u), (Device{x, 7}));
  EXPECT_EQ(parse_model("fx3u"), Model::fx3u);
}

TEST(FxDeviceName, x8_x9_and_x18_do_not_exist) {
  for (const auto* name : {"X8", "X9", "X18", "Y80", "Y108"}) {
    const auto parsed = parse_device(name, Model::fx3u);
    ASSERT_FALSE(parsed.has_value()) << name;
    EXPECT_EQ(parsed.error(), DeviceError::not_octal) << name;
  }
}

TEST(FxDeviceName, text_that_names_no_device_is_refused) {
  for (const auto* name :
       {"", "D", "12", "Q1", "T10", "C0", "D1x", "D-1", "D 1", "DD1", "X1.5", "MM", "1D"}) {
    const auto parsed = parse_device(name, Model::fx3u);
    ASSERT_FALSE(parsed.has_value()) << name;
    EXPECT_EQ(parsed.error(), DeviceError::not_a_device) << name;
  }
}

TEST(FxDeviceName, a_number_beyond_any_model_does_not_wrap) {
  for (const auto* name : {"D8512", "D65535", "D65536", "D99999999999999999999", "X400", "X200000"}) {
    const auto parsed = parse_device(name, Model::fx3u);
    ASSERT_FALSE(parsed.has_value()) << name;
    EXPECT_EQ(parsed.error(), DeviceError::out_of_range) << name;
  }
}

struct Limit {
  Model model;
  const char* last;          ///< exists
  const char* first_beyond;  ///< does not
};

TEST(FxDeviceRange, each_model_ends_where_its_manual_says) {
  const Limit limits[] = {
      {Model::fx1s, "X17", "X20"},     {Model::fx1s, "Y15", "Y16"},     {Model::fx1s, "M511", "M512"},
      {Model::fx1s, "S127", "S128"},   {Model::fx1s, "TN63", "TN64"},   {Model::fx1s, "CN31", "CN32"},
      {Model::fx1s, "CN235", "CN234"}, {Model::fx1s, "CS255", "CS256"}, {Model::fx1s, "D255", "D256"},
      {Model::fx1s, "M8255", "M8256"}, {Model::fx1n, "X177", "X200"},   {Model::fx1n, "Y177", "Y200"},
      {Model::fx1n, "M1535", "M1536"}, {Model::fx1n, "S999", "S1000"},  {Model::fx1n, "TS255", "TS256"},
      {Model::fx1n, "D7999", "D8256"}, {Model::fx2n, "X267", "X270"},   {Model::fx2n, "M3071", "M3072"},
      {Model::fx2n, "D8255", "D8256"}, {Model::fx3u, "X377", "X400"},   {Model::fx3u, "M7679", "M7680"},
      {Model::fx3u, "S4095", "S4096"}, {Model::fx3u, "TN511", "TN512"}, {Model::fx3u, "CN255", "CN256"},
      {Model::fx3u, "D8511", "D8512"}, {Model::fx3u, "M8511", "M8512"},
  };
  for (const Limit& limit : limits) {
    EXPECT_TRUE(parse_device(limit.last, limit.model).has_value()) << to_string(limit.model) << limit.last;
    const auto beyond = parse_device(limit.first_beyond, limit.model);
    ASSERT_FALSE(beyond.has_value()) << to_string(limit.model) << limit.first_beyond;
    EXPECT_EQ(beyond.error(), DeviceError::out_of_range);
  }
}

TEST(FxDeviceRange, counters_are_32_bit_from_200_on) {
  EXPECT_EQ(width_bits({c_value, 199}), 16U);
  EXPECT_EQ(width_bits({c_value, 200}), 32U);
  EXPECT_EQ(width_bits({c_contact, 200}), 1U);
  EXPECT_EQ(width_bits({d, 200}), 16U);
}

TEST(FxModel, an_unknown_model_is_refused) {
  for (const auto* name : {"", "FX", "FX3", "FX3UC", "FX2"})
    EXPECT_EQ(parse_model(name), std::nullopt) << name;
}

}  // namespace
}  // namespace protocol::fx
