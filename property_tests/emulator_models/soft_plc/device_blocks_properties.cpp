// Timers and counters of an FX, whose contact and value lie in the PLC's memory, against their equations.

#include <algorithm>
#include <array>
#include <cstring>
#include <ostream>

#include "emulator_models/soft_plc/device_blocks.hpp"
#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

using namespace emulator_models::soft_plc;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

/// Memory with one block's devices in its middle, and ones all around that nobody may touch.
class Devices {
 public:
  Devices() {
    memory_.fill(std::byte{0xFF});
    clear();
  }

  [[nodiscard]] BlockDevices places(milliseconds unit) const { return {{1, 5}, 4, {10, 2}, unit}; }
  [[nodiscard]] std::byte* memory() noexcept { return memory_.data(); }
  void count_down(bool down) {
    memory_[10] = down ? std::byte{0xFF} : std::byte{0xFB};
    expected_[10] = memory_[10];
  }
  template <class Value>
  [[nodiscard]] bool show(Value value, bool contact) {
    std::memcpy(expected_.data() + 4, &value, sizeof value);
    expected_[1] = contact ? std::byte{0xFF} : std::byte{0xDF};
    return memory_ == expected_;
  }

 private:
  void clear() {
    std::fill_n(memory_.begin() + 4, 4, std::byte{0});
    memory_[1] = std::byte{0xDF};
    expected_ = memory_;
  }

  std::array<std::byte, 16> memory_{};
  std::array<std::byte, 16> expected_{};
};

struct Call {
  nanoseconds passed;
  bool in;
  bool r;
};

void showValue(const Call& call, std::ostream& out) {
  out << '+' << call.passed.count() << (call.in ? " on" : " off") << (call.r ? " R" : "");
}

/// Times of half units and of odd nanoseconds; rarely a long gap.
std::vector<Call> any_calls(milliseconds unit) {
  return *rc::gen::container<std::vector<Call>>(rc::gen::exec([unit] {
    const int halves = *rc::gen::inRange(0, 12) == 0 ? *rc::gen::inRange(0, 2000) : *rc::gen::inRange(0, 5);
    return Call{nanoseconds{unit} / 2 * halves + nanoseconds{*rc::gen::inRange(0, 3)},
                *rc::gen::inRange(0, 4) != 0, *rc::gen::inRange(0, 10) == 9};
  }));
}

milliseconds any_unit() { return milliseconds{*rc::gen::element(1, 10, 100)}; }

// Value: whole units since IN has come, PV at most.
PROPERTY(DeviceTimer, counts_whole_units_since_in_has_come, ()) {
  const milliseconds unit = any_unit();
  Devices devices;
  DeviceTimer timer;
  timer.devices = devices.places(unit);
  timer.pv = static_cast<std::int16_t>(*rc::gen::inRange(-1, 12));
  const std::int64_t preset = std::max<std::int64_t>(timer.pv, 0);
  nanoseconds now{0};
  nanoseconds on_since{0};
  bool was_on = false;
  for (const Call& call : any_calls(unit)) {
    now += call.passed;
    timer.in = call.in;
    timer.call(devices.memory(), now);
    if (call.in && !was_on) on_since = now;
    was_on = call.in;
    const std::int64_t value = call.in ? std::min((now - on_since) / unit, preset) : 0;
    RC_ASSERT(devices.show(static_cast<std::int16_t>(value), call.in && value >= preset));
  }
}

// Value: whole units of all the time that IN has been on since R, PV at most. Time counts from a call with IN on to the next.
PROPERTY(DeviceTimer, retentive_counts_the_time_with_in_since_r, ()) {
  const milliseconds unit = any_unit();
  Devices devices;
  DeviceTimer timer;
  timer.devices = devices.places(unit);
  timer.pv = static_cast<std::int16_t>(*rc::gen::inRange(1, 12));
  nanoseconds now{0};
  nanoseconds on_for{0};
  bool was_on = false;
  bool contact = false;
  for (const Call& call : any_calls(unit)) {
    now += call.passed;
    timer.in = call.in;
    timer.r = call.r;
    timer.call_retentive(devices.memory(), now);
    if (call.r) {
      on_for = nanoseconds{0};
      contact = was_on = false;
    } else {
      if (was_on && call.in) on_for += call.passed;
      was_on = call.in;
      contact = on_for / unit >= timer.pv;
    }
    const std::int64_t value = std::min<std::int64_t>(on_for / unit, timer.pv);
    RC_ASSERT(devices.show(static_cast<std::int16_t>(value), contact));
  }
}

PROPERTY(DeviceCounter, counts_edges_since_r_and_stays_at_pv, ()) {
  Devices devices;
  DeviceCounter counter;
  counter.devices = devices.places({});
  counter.pv = static_cast<std::int16_t>(*rc::gen::inRange(-2, 8));
  int edges = 0;
  bool was_on = false;
  for (const Call& call : any_calls(milliseconds{1})) {
    counter.cu = call.in;
    counter.r = call.r;
    counter.call(devices.memory());
    if (call.in && !was_on) ++edges;
    was_on = call.in;
    if (call.r) edges = 0;
    const int value = std::min(edges, std::max<int>(counter.pv, 0));
    RC_ASSERT(devices.show(static_cast<std::int16_t>(value), !call.r && value >= counter.pv));
  }
}

PROPERTY(WideDeviceCounter, counts_both_ways_and_wraps, ()) {
  Devices devices;
  WideDeviceCounter counter;
  counter.devices = devices.places({});
  counter.pv = *rc::gen::element(0, 3, -2, 2147483647, -2147483647 - 1);
  std::int64_t count = *rc::gen::element(0LL, 2147483646LL, -2147483647LL);
  const auto begin = static_cast<std::int32_t>(count);
  std::memcpy(devices.memory() + 4, &begin, sizeof begin);
  bool was_on = false;
  for (const Call& call : any_calls(milliseconds{1})) {
    const bool down = *rc::gen::arbitrary<bool>();
    devices.count_down(down);
    counter.cu = call.in;
    counter.r = call.r;
    counter.call(devices.memory());
    if (call.in && !was_on) count += down ? -1 : 1;
    was_on = call.in;
    if (call.r) count = 0;
    if (count > 2147483647LL) count -= 4294967296LL;
    if (count < -2147483648LL) count += 4294967296LL;
    RC_ASSERT(devices.show(static_cast<std::int32_t>(count), !call.r && count >= counter.pv));
  }
}

}  // namespace
}  // namespace property_tests
