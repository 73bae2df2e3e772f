#include "emulator_models/plc_view.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace emulator_models {
namespace {

using protocol::fx::Device;
using protocol::fx::DeviceKind;

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

PlcView::PlcView(Style style, const DeviceMemory& memory, std::span<const DeviceLabel> labels)
    : style_{style}, shown_{memory}, labels_{labels} {}

std::string_view PlcView::label_of(Device device) const noexcept {
  const auto found = std::ranges::find(labels_, device, &DeviceLabel::device);
  return found == labels_.end() ? std::string_view{} : found->text;
}

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

  const auto on = [&](std::uint16_t special) { return shown_.get({DeviceKind::m, special}) != 0; };
  const std::string_view lamp = on(8061) ? ", CPU-E" : on(8067) ? ", PROG-E" : "";
  std::string text{home_and_clear};
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{} in {}{}, last scan {:.1f} ms (longest {:.1f}), after {:.1f} s. Ctrl-C ends.\n\n",
                 protocol::fx::to_string(shown_.model()), on(8000) ? "RUN" : "STOP", lamp,
                 milliseconds(shown_, 8010), milliseconds(shown_, 8012), seconds(elapsed));
  std::size_t column = 0;
  for (const DeviceLabel& label : labels_) {
    if (!protocol::fx::exists(label.device, shown_.model())) continue;
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
