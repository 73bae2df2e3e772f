#include "tests/protocol/fx/worked_examples.hpp"

#include <cstdlib>

namespace protocol::fx::examples {
namespace {

using enum Command;

constexpr RequestExample request_examples[] = {
    {"read Y0-Y17", "02 30 30 30 41 30 30 32 03 36 36", read, 0x00A0, 2, ""},
    {"read X0-X17", "02 30 30 30 38 30 30 32 03 35 44", read, 0x0080, 2, ""},
    {"read Y0-Y7", "02 30 30 30 41 30 30 31 03 36 35", read, 0x00A0, 1, ""},
    {"read D123, D124", "02 30 31 30 46 36 30 34 03 37 34", read, 0x10F6, 4, ""},
    {"write D123 = 1234H, D124 = ABCDH", "02 31 31 30 46 36 30 34 33 34 31 32 43 44 41 42 03 34 39", write,
     0x10F6, 4, "34 12 CD AB"},
    {"read M8000-M8007", "02 30 30 31 45 30 30 31 03 36 41", read, 0x01E0, 1, ""},
    {"read D8001", "02 30 30 45 30 32 30 32 03 36 43", read, 0x0E02, 2, ""},
    {"read D8101", "02 30 30 45 43 41 30 32 03 38 45", read, 0x0ECA, 2, ""},
    {"read T10 value", "02 30 30 38 31 34 30 32 03 36 32", read, 0x0814, 2, ""},
    {"read C200 value", "02 30 30 43 30 30 30 34 03 36 41", read, 0x0C00, 4, ""},
    {"read 64 bytes from D0", "02 30 31 30 30 30 34 30 03 35 38", read, 0x1000, 64, ""},
    {"write D8000 = 300", "02 31 30 45 30 30 30 32 32 43 30 31 03 34 31", write, 0x0E00, 2, "2C 01"},
    {"force Y0 on (sum FF)", "02 37 30 30 30 35 03 46 46", force_on, 0x0500, 0, ""},
    {"force Y0 off (sum 00)", "02 38 30 30 30 35 03 30 30", force_off, 0x0500, 0, ""},
    {"force Y20 on (sum 00)", "02 37 31 30 30 35 03 30 30", force_on, 0x0510, 0, ""},
    {"force M100 on", "02 37 36 34 30 38 03 30 43", force_on, 0x0864, 0, ""},
    {"force M100 off", "02 38 36 34 30 38 03 30 44", force_off, 0x0864, 0, ""},
    {"force S0 on", "02 37 30 30 30 30 03 46 41", force_on, 0x0000, 0, ""},
    {"force M8037 on (STOP)", "02 37 32 35 30 46 03 31 37", force_on, 0x0F25, 0, ""},
    {"wide read D0", "02 45 30 30 34 30 30 30 30 32 03 43 45", read_wide, 0x4000, 2, ""},
    {"wide write D100 = 258", "02 45 31 30 34 30 43 38 30 32 30 32 30 31 03 41 44", write_wide, 0x40C8, 2,
     "02 01"},
    {"wide read D8127", "02 45 30 30 38 30 46 45 30 32 03 46 44", read_wide, 0x80FE, 2, ""},
    {"FX1N run state", "02 45 30 30 30 31 43 30 30 31 03 44 44", read_wide, 0x01C0, 1, ""},
    {"wide force M0 on", "02 45 37 30 30 34 30 03 34 33", force_on_wide, 0x4000, 0, ""},
    {"wide force M0 off", "02 45 38 30 30 34 30 03 34 34", force_off_wide, 0x4000, 0, ""},
    {"wide force Y0 on", "02 45 37 30 30 35 45 03 35 39", force_on_wide, 0x5E00, 0, ""},
    {"read parameters of FX1S", "02 30 38 30 30 30 32 45 03 37 32", read, 0x8000, 0x2E, ""},
};

constexpr ReplyExample reply_examples[] = {
    {"Y0-Y7 = 3FH", "02 33 46 03 37 43", "3F"},
    {"D123 = 1234H, D124 = ABCDH", "02 33 34 31 32 43 44 41 42 03 44 37", "34 12 CD AB"},
    {"M8000-M8007 in RUN", "02 30 39 03 36 43", "09"},
    {"M8000-M8007 in STOP", "02 30 41 03 37 34", "0A"},
    {"D8001 of an FX1N V2.10", "02 36 32 36 36 03 44 37", "62 66"},
    {"D8001 of an FX1S V2.10", "02 43 32 35 36 03 45 33", "C2 56"},
    {"D8001 of a 24-type V2.41", "02 42 31 35 45 03 46 30", "B1 5E"},
    {"D8101 of an FX3U", "02 37 31 33 46 03 45 34", "71 3F"},
    {"D8127 = 0", "02 30 30 30 30 03 43 33", "00 00"},
    {"3584 with its right sum, D7", "02 33 35 38 34 03 44 37", "35 84"},
};

unsigned digit_value(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10U;
  std::abort();
}

}  // namespace

std::vector<std::byte> bytes(std::string_view hex) {
  std::vector<std::byte> result;
  for (std::size_t i = 0; i < hex.size(); i += 3)
    result.push_back(static_cast<std::byte>(digit_value(hex.at(i)) << 4U | digit_value(hex.at(i + 1))));
  return result;
}

std::span<const RequestExample> requests() { return request_examples; }
std::span<const ReplyExample> replies() { return reply_examples; }

}  // namespace protocol::fx::examples
