#include "emulator_models/latched_ranges.hpp"

namespace emulator_models {
namespace {

using protocol::fx::DeviceKind;
using protocol::fx::Model;

constexpr std::uint16_t all = 0xFFFF;

/// The number from which on the devices are latched. Of the counters below 200; above, all models alike.
struct FirstLatched {
  std::uint16_t m, s, c, d;
};

constexpr FirstLatched first_latched_of(Model model) noexcept {
  switch (model) {
    case Model::fx1s:
      return {.m = 384, .s = 0, .c = 16, .d = 128};
    case Model::fx1n:
      return {.m = 384, .s = 0, .c = 16, .d = 128};
    case Model::fx2n:
    case Model::fx3u:
      return {.m = 500, .s = 500, .c = 100, .d = 200};
  }
  return {};
}

constexpr std::uint16_t first_retentive_timer = 246;
constexpr std::uint16_t first_timer_behind_retentive = 256;
constexpr std::uint16_t first_wide_counter = 200;
constexpr std::uint16_t wide_unlatched_count = 20;
// What is wired is no memory, though it lies where some models latch (terminals.hpp).
constexpr std::uint16_t first_terminal_word = 200;
constexpr std::uint16_t terminal_words_count = 18;

}  // namespace

void clear_unlatched(DeviceMemory& memory) noexcept {
  const FirstLatched first = first_latched_of(memory.model());
  memory.clear(DeviceKind::y, 0, all);
  memory.clear(DeviceKind::m, 0, first.m);
  memory.clear(DeviceKind::s, 0, first.s);
  memory.clear(DeviceKind::d, 0, first.d);
  memory.clear(DeviceKind::d, first_terminal_word, terminal_words_count);
  for (const DeviceKind kind : {DeviceKind::t_contact, DeviceKind::t_value}) {
    memory.clear(kind, 0, first_retentive_timer);
    memory.clear(kind, first_timer_behind_retentive, all);
  }
  for (const DeviceKind kind : {DeviceKind::c_contact, DeviceKind::c_value}) {
    memory.clear(kind, 0, first.c);
    memory.clear(kind, first_wide_counter, wide_unlatched_count);
  }
}

void clear_all_but_special(DeviceMemory& memory) noexcept {
  for (const DeviceKind kind :
       {DeviceKind::y, DeviceKind::m, DeviceKind::s, DeviceKind::t_contact, DeviceKind::c_contact,
        DeviceKind::t_value, DeviceKind::c_value, DeviceKind::d})
    memory.clear(kind, 0, all);
}

}  // namespace emulator_models
