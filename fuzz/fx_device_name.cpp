// Names of devices, as they stand in programs and configurations, and where the programming port shows what they name.
//
//   line 1   a model
//   line 2   a device
//
// Whatever is no name of a model counts as an FX2N, so that most inputs are about devices.

#include <string>

#include "fuzz/text_input.hpp"
#include "protocol/fx/address_map.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

namespace {

using namespace protocol::fx;

Model model_of(std::string_view name) {
  const auto model = parse_model(name);
  if (!model) return Model::fx2n;
  ltsim::expect(parse_model(to_string(*model)) == model, "the name of a model is that of the model");
  return *model;
}

/// As it is printed: in capitals, the number without zeros before it.
std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c == '0' && !text.empty() && text.back() >= 'A') continue;
    text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  if (text.back() >= 'A') text += '0';
  return text;
}

/// The byte, and the bit of a bit device, are those of this device and not of another.
void check_place(Device device, Model model, AddressSpace space) {
  const auto address = byte_address(device, model, space);
  const auto bit = bit_number(device, model, space);
  ltsim::expect(!bit || width_bits(device) == 1, "only a bit device has the number of a bit");
  if (bit) ltsim::expect(locate_bit(*bit, model, space) == device, "the bit of a device leads back to it");
  if (!address) {
    ltsim::expect(!bit, "a device without a byte has no bit");
    return;
  }
  const auto found = locate_byte(*address, model, space);
  ltsim::expect(found && found->device.kind == device.kind, "the byte of a device leads back to its kind");
  ltsim::expect(found->device.number <= device.number &&
                    device.number < found->device.number + (width_bits(device) == 1 ? 8U : 1U),
                "the byte of a device leads back to it, or to the first of eight");
  ltsim::expect(found->byte_in_device == 0, "a device begins with its first byte");
}

}  // namespace

FUZZ_TARGET("fx-device-name", {},
            "the name of a device: read, written and read, found in both address spaces") {
  const std::string_view text = fuzz::text_of(input);
  const Model model = model_of(text.substr(0, text.find('\n')));
  const std::string_view name = fuzz::line_of(text, 2).value_or(text);
  const auto device = parse_device(name, model);
  const auto swapped = parse_device(fuzz::with_cases_swapped(name), model);
  ltsim::expect(device == swapped, "upper and lower case mean the same");
  if (!device) {
    ltsim::expect(!to_string(device.error()).empty(), "a refusal has words");
    return;
  }
  ltsim::expect(exists(*device, model), "what is read exists on its model");
  ltsim::expect(to_string(*device) == plain(name), "a device is the one that is named");
  check_place(*device, model, AddressSpace::legacy);
  check_place(*device, model, AddressSpace::wide);
}
