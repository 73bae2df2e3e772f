#include "emulator_models/plc_view.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "emulator_models/machine_devices.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

struct Label {
  Device device;
  std::string_view text;
};

constexpr Label labels[] = {
    {machine::m_strobe, "MF"},
    {machine::m_code, "M code"},
    {machine::s_strobe, "SF"},
    {machine::s_value, "S value"},
    {machine::t_strobe, "TF"},
    {machine::t_number, "T number"},
    {machine::distribution_end, "DEN"},
    {machine::program_running, "program running"},
    {machine::reset, "reset"},
    {machine::feed_hold_active, "feed hold"},
    {machine::fin, "FIN"},
    {machine::alarm, "alarm"},
    {machine::alarm_number, "alarm number"},
    {machine::emergency_stop_ok, "E-stop OK"},
    {machine::spindle_at_speed, "spindle at speed"},
    {machine::door_closed, "door closed"},
    {machine::feed_enable, "feed enable"},
    {machine::cycle_start_enable, "cycle start enable"},
    {machine::spindle_clockwise, "spindle cw"},
    {machine::spindle_counter_clockwise, "spindle ccw"},
    {machine::spindle_speed, "spindle speed"},
    {machine::flood_coolant, "flood coolant"},
    {machine::mist_coolant, "mist coolant"},
    {machine::tool_magazine, "tool magazine"},
    {machine::tool_clamp_release, "tool clamp release"},
    {machine::selected_tool, "selected tool"},
    {machine::tool_in_spindle, "tool in spindle"},
    {machine::green_lamp, "green lamp"},
    {machine::yellow_lamp, "yellow lamp"},
    {machine::red_lamp, "red lamp"},
    {machine::at_speed_switch, "at speed"},
    {machine::zero_speed_switch, "zero speed"},
    {machine::flood_flow_switch, "flood flow"},
    {machine::mist_flow_switch, "mist flow"},
    {machine::tool_changed_switch, "tool changed"},
    {machine::door_switch, "door closed"},
    {machine::emergency_stop_chain, "E-stop chain"},
    {{DeviceKind::m, 8062}, "port error"},
    {{DeviceKind::d, 8062}, "port error code"},
};

std::string_view label_of(Device device) {
  const auto* const found = std::find_if(std::begin(labels), std::end(labels),
                                         [&](const Label& label) { return label.device == device; });
  return found == std::end(labels) ? std::string_view{} : found->text;
}

bool changes_by_itself(Device device) {
  const auto within = [&](unsigned first, unsigned last) {
    return device.number >= first && device.number <= last;
  };
  return (device.kind == DeviceKind::m && within(8011, 8014)) ||
         (device.kind == DeviceKind::d && within(8010, 8019));
}

double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

/// Units of 0.1 ms, as D8010 to D8012 count.
double milliseconds(const DeviceMemory& memory, std::uint16_t number) {
  return memory.get({DeviceKind::d, number}) / 10.0;
}

}  // namespace

PlcView::PlcView(Style style, const DeviceMemory& memory) : style_{style}, shown_{memory} {}

std::string PlcView::update(const DeviceMemory& memory, std::chrono::nanoseconds elapsed) {
  std::string lines;
  for (const Device device : memory.differences(shown_)) {
    if (changes_by_itself(device)) continue;
    const std::string line =
        fmt::format("{:9.3f} s  {:<6} {:>5} -> {:<5}  {}", seconds(elapsed), protocol::fx::to_string(device),
                    shown_.get(device), memory.get(device), label_of(device));
    lines += line + '\n';
    last_changes_.push_back(line);
    if (last_changes_.size() > shown_changes_max) last_changes_.pop_front();
  }
  shown_ = memory;
  if (style_ == Style::lines) return lines;
  if (lines.empty() && !nothing_shown_yet_) return {};
  nothing_shown_yet_ = false;
  return screen(elapsed);
}

std::string PlcView::screen(std::chrono::nanoseconds elapsed) const {
  constexpr std::string_view home_and_clear = "\x1b[H\x1b[2J";
  constexpr std::string_view bold = "\x1b[1m";
  constexpr std::string_view plain = "\x1b[0m";
  constexpr std::size_t columns_count = 3;

  const bool runs = shown_.get({DeviceKind::m, 8000}) != 0;
  std::string text{home_and_clear};
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} in {}, last scan {:.1f} ms (longest {:.1f}), after {:.1f} s. Ctrl-C ends.\n\n",
                 protocol::fx::to_string(shown_.model()), runs ? "RUN" : "STOP", milliseconds(shown_, 8010),
                 milliseconds(shown_, 8012), seconds(elapsed));
  std::size_t column = 0;
  for (const Label& label : labels) {
    const std::uint32_t value = shown_.get(label.device);
    fmt::format_to(out, "{}{:<6}{:<19}{:>5}{}", value != 0 ? bold : plain,
                   protocol::fx::to_string(label.device), label.text, value, plain);
    column = (column + 1) % columns_count;
    text += column == 0 ? "\n" : "  ";
  }
  text += "\n\nLast changes\n";
  for (const std::string& line : last_changes_) text += line + '\n';
  return text;
}

}  // namespace emulator_models
