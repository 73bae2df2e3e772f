#include "kernel_mocks/axis_control.hpp"

#include "kernel_mocks/plc_signals.hpp"

namespace kernel_mocks {

RunStep AxisControl::begin_program() {
  return set_at_tool_change_position("program start", options_.axes.tool_change_z <= 0);
}

void AxisControl::spindle_given(SpindleEffect effect) noexcept {
  if (effect != SpindleEffect::none) spindle_has_started_ = effect == SpindleEffect::start;
}

RunStep AxisControl::wait_for_spindle(const Block& block) {
  if (!spindle_has_started_) return {};
  const auto since = std::chrono::steady_clock::now();
  std::chrono::nanoseconds waited{0};
  bool at_speed = false;
  auto done = watch_.wait_watching(
      place_of(block), [&] { return waited >= options_.spindle_timeout; },
      [&](std::byte status) {
        at_speed = (status & signals::spindle_at_speed) != std::byte{0};
        waited = std::chrono::steady_clock::now() - since;
        return at_speed;
      });
  if (!done) return done;
  if (!at_speed) {
    return tl::unexpected{
        failed_at(place_of(block), {.fault = LogicFault::spindle_not_at_speed, .after = waited})};
  }
  // Once after each start: what the speed does later is the PLC's alarm.
  spindle_has_started_ = false;
  return {};
}

RunStep AxisControl::move(const Block& block, const Motion& motion) {
  const std::string where = place_of(block);
  const bool arrives_at_tool_change = motion.z >= options_.axes.tool_change_z;
  if (motion.duration == std::chrono::nanoseconds{0}) {
    return set_at_tool_change_position(where, arrives_at_tool_change);
  }
  if (!arrives_at_tool_change) {
    if (auto done = set_at_tool_change_position(where, false); !done) return done;
  }
  if (auto done = as_step(where, logic_task_.set_motion_under_way(true)); !done) return done;
  // Held until a status has shown that it may move.
  geometry_.set_held(true);
  geometry_.start(motion.duration);
  auto done = watch_.wait_watching(
      where, [&] { return !geometry_.is_moving(); },
      [&](std::byte status) {
        const bool enabled = (status & signals::feed_enable) != std::byte{0};
        geometry_.set_held(motion.kind != MotionKind::dwell && (watch_.is_held() || !enabled));
        return false;
      });
  if (!done) return done;
  if (done = as_step(where, logic_task_.set_motion_under_way(false)); !done) return done;
  return set_at_tool_change_position(where, arrives_at_tool_change);
}

RunStep AxisControl::set_at_tool_change_position(const std::string& where, bool there) {
  if (at_tool_change_position_ == there) return {};
  at_tool_change_position_ = there;
  return as_step(where, logic_task_.set_at_tool_change_position(there));
}

}  // namespace kernel_mocks
