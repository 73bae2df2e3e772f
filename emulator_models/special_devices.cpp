#include "emulator_models/special_devices.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using protocol::fx::Model;

constexpr Device special_m(std::uint16_t number) noexcept { return {DeviceKind::m, number}; }
constexpr Device special_d(std::uint16_t number) noexcept { return {DeviceKind::d, number}; }

/// Two-digit model code, then version x 100. An FX3U reports itself as a 24-type here, for the sake of old
/// tools.
constexpr std::uint16_t type_and_version(Model model) noexcept {
  switch (model) {
    case Model::fx1s:
      return 22210;
    case Model::fx1n:
      return 26210;
    case Model::fx2n:
    case Model::fx3u:
      return 24241;
  }
  return 0;
}

constexpr std::uint16_t fx3u_type_and_version = 16241;
constexpr std::uint16_t watchdog_ms_at_power_up = 200;

}  // namespace

void set_power_up_values(DeviceMemory& memory) noexcept {
  memory.set(watchdog_time, watchdog_ms_at_power_up);
  memory.set(special_d(8001), type_and_version(memory.model()));
  if (memory.model() == Model::fx3u) memory.set(special_d(8101), fx3u_type_and_version);
  set_run_flags(memory, RunMode::stop);
}

void set_run_flags(DeviceMemory& memory, RunMode mode) noexcept {
  memory.set(special_m(8000), mode != RunMode::stop);
  memory.set(special_m(8001), mode == RunMode::stop);
  memory.set(special_m(8002), mode == RunMode::first_run_scan);
  memory.set(special_m(8003), mode != RunMode::first_run_scan);
}

void set_clock_flags(DeviceMemory& memory, std::chrono::nanoseconds since_power_up) noexcept {
  constexpr struct {
    std::uint16_t number;
    std::chrono::nanoseconds period;
  } clocks[] = {{8011, 10ms}, {8012, 100ms}, {8013, 1s}, {8014, 1min}};
  for (const auto& clock : clocks)
    memory.set(special_m(clock.number), since_power_up % clock.period >= clock.period / 2);
}

void set_calendar(DeviceMemory& memory, WallTime now) noexcept {
  const auto day = std::chrono::floor<std::chrono::days>(now);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss time{std::chrono::floor<std::chrono::seconds>(now - day)};
  memory.set(special_d(8013), static_cast<std::uint32_t>(time.seconds().count()));
  memory.set(special_d(8014), static_cast<std::uint32_t>(time.minutes().count()));
  memory.set(special_d(8015), static_cast<std::uint32_t>(time.hours().count()));
  memory.set(special_d(8016), static_cast<unsigned>(date.day()));
  memory.set(special_d(8017), static_cast<unsigned>(date.month()));
  memory.set(special_d(8018), static_cast<std::uint32_t>(static_cast<int>(date.year())));
  memory.set(special_d(8019), std::chrono::weekday{day}.c_encoding());
}

void note_port_trouble(DeviceMemory& memory, PortTrouble trouble) noexcept {
  memory.set(special_m(8062), 1);
  memory.set(special_d(8062), static_cast<std::uint32_t>(trouble));
}

bool obey_remote_switch(DeviceMemory& memory, bool running) noexcept {
  if (memory.get(special_m(8037)) != 0) {
    for (std::uint16_t number = 8035; number <= 8037; ++number) memory.set(special_m(number), 0);
    return false;
  }
  return running || (memory.get(special_m(8035)) != 0 && memory.get(special_m(8036)) != 0);
}

bool is_read_only(Device device, Model model) noexcept {
  const auto within = [&](std::uint16_t first, std::uint16_t last) {
    return device.number >= first && device.number <= last;
  };
  if (device.kind == DeviceKind::m) return within(8000, 8003) || within(8011, 8014);
  if (device.kind == DeviceKind::d)
    return within(8001, 8001) || within(8010, 8019) || (model == Model::fx3u && within(8101, 8101));
  return false;
}

}  // namespace emulator_models
