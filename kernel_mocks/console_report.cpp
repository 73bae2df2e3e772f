#include "kernel_mocks/console_report.hpp"

#include <cstdio>
#include <string>

#include <fmt/format.h>

namespace kernel_mocks {
namespace {

// Through a pipe the lines would otherwise come all at the end.
void print_line(const std::string& line) noexcept {
  std::puts(line.c_str());
  std::fflush(stdout);
}

}  // namespace

void ConsoleReport::given(const Block& block, const FunctionRequest& request, TimePoint at) noexcept {
  table_.given(block, request, at);
}

void ConsoleReport::not_acknowledged(const Block& /*block*/, const FunctionRequest& /*request*/,
                                     const LogicFailure& failure) noexcept {
  table_.not_acknowledged(failure, std::chrono::steady_clock::now());
}

void ConsoleReport::acknowledged(const Block& block, const FunctionRequest& request,
                                 std::chrono::nanoseconds duration) noexcept {
  ++function_count_;
  table_.acknowledged(duration);
  print_line(fmt::format("{:<9} {:<20} FIN after {:.2f} s", name_of(block), to_string(request),
                         std::chrono::duration<double>(duration).count()));
  show_outputs();
}

void ConsoleReport::stop_passed(const Block& block) noexcept {
  print_line(fmt::format("{:<9} program stop: going on at once", name_of(block)));
}

void ConsoleReport::moved(const Block& /*block*/, MotionKind kind, std::chrono::nanoseconds duration,
                          bool reached) noexcept {
  ++motion_count_;
  table_.moved(kind, duration, reached);
}

void ConsoleReport::show_outputs() noexcept {
  using protocol::fx::Device;
  using protocol::fx::DeviceKind;
  Outputs now{};
  const auto read = link_.read_bytes({DeviceKind::y, 0}, now);
  if (!read) {
    print_line(fmt::format("{:>30} outputs not read: {}", "", to_string(read.error())));
    return;
  }
  std::string changes;
  for (std::uint16_t index = 0; index < 8 * now.size(); ++index) {
    const auto bit = [index](const Outputs& outputs) {
      return (outputs[index / 8] >> (index % 8) & std::byte{1}) != std::byte{0};
    };
    if (bit(now) == bit(outputs_)) continue;
    changes += fmt::format("{}{} {}", changes.empty() ? "" : "  ",
                           protocol::fx::to_string(Device{DeviceKind::y, index}), bit(now) ? "on" : "off");
  }
  outputs_ = now;
  if (!changes.empty()) print_line(fmt::format("{:>30} {}", "", changes));
}

}  // namespace kernel_mocks
