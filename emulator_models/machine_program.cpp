#include "emulator_models/machine_program.hpp"

#include <algorithm>

#include "emulator_models/machine_devices.hpp"

namespace emulator_models {
namespace {

using protocol::fx::Device;

constexpr Device first_scan{protocol::fx::DeviceKind::m, 8002};

constexpr Device moving_outputs[] = {machine::spindle_clockwise, machine::spindle_counter_clockwise,
                                     machine::flood_coolant,     machine::mist_coolant,
                                     machine::tool_magazine,     machine::tool_clamp_release};

}  // namespace

/// The device memory as the program uses it in one scan.
class MachineProgram::Image {
 public:
  explicit Image(DeviceMemory& memory) noexcept : memory_{memory} {}

  [[nodiscard]] bool is_on(Device device) const noexcept { return memory_.get(device) != 0; }
  [[nodiscard]] std::uint16_t word(Device device) const noexcept {
    return static_cast<std::uint16_t>(memory_.get(device));
  }
  [[nodiscard]] bool spindle_is_ordered() const noexcept {
    return is_on(machine::spindle_clockwise) || is_on(machine::spindle_counter_clockwise);
  }

  void store(Device device, std::uint32_t value) noexcept { memory_.set(device, value); }
  /// Stores what moves the machine.
  void order(Device output, std::uint32_t value) noexcept {
    order_is_new_ = order_is_new_ || memory_.get(output) != value;
    memory_.set(output, value);
  }
  /// A feedback, to be believed: after a new order the inputs of this scan are older than the order.
  [[nodiscard]] bool confirms(bool feedback) const noexcept { return feedback && !order_is_new_; }

 private:
  DeviceMemory& memory_;
  bool order_is_new_ = false;
};

MachineProgram::MachineProgram(MachineObserver* observer) noexcept
    : observer_{observer},
      functions_{{{FunctionKind::t, machine::t_number, machine::t_strobe},
                  {FunctionKind::s, machine::s_value, machine::s_strobe},
                  {FunctionKind::m, machine::m_code, machine::m_strobe}}} {}

void MachineProgram::run(DeviceMemory& memory, SteadyTime now) noexcept {
  Image image{memory};
  if (image.is_on(first_scan)) {
    abandon(image);
    // After a STOP, a strobe that is still on may have been executed before; at power-up it cannot have been.
    if (!has_run_) handshake_ = Handshake::idle;
    has_run_ = true;
  }
  watch_safety(image);
  if (image.is_on(machine::reset)) {
    abandon(image);
    if (image.is_on(machine::emergency_stop_chain)) alarm_ = MachineAlarm::none;
  }
  run_handshake(image, now);
  publish(image);
}

void MachineProgram::watch_safety(Image& image) noexcept {
  if (!image.is_on(machine::emergency_stop_chain)) {
    raise_alarm(MachineAlarm::emergency_stop, image);
  } else if (!image.is_on(machine::door_switch) && image.spindle_is_ordered()) {
    raise_alarm(MachineAlarm::door_open, image);
  } else if (alarm_ != MachineAlarm::none) {
    abandon(image);  // I4, also for an output that was forced on meanwhile
  }
}

void MachineProgram::run_handshake(Image& image, SteadyTime now) noexcept {
  bool any_strobe = false;
  for (Function& function : functions_) {
    const bool strobe = image.is_on(function.strobe_device);
    if (!strobe) withdraw(function, image);
    any_strobe = any_strobe || strobe;
  }
  if (!any_strobe) handshake_ = Handshake::idle;
  if (!any_strobe || handshake_ == Handshake::finished || handshake_ == Handshake::abandoned) return;

  handshake_ = Handshake::executing;
  for (Function& function : functions_) {
    if (!image.is_on(function.strobe_device)) continue;
    if (function.progress == Progress::none) start(function, image, now);
    go_on(function, image, now);
    if (handshake_ == Handshake::abandoned) return;
  }
  const bool something_runs = std::any_of(functions_.begin(), functions_.end(), [](const Function& function) {
    return function.progress == Progress::running;
  });
  if (!something_runs) handshake_ = Handshake::finished;
}

void MachineProgram::start(Function& function, const Image& image, SteadyTime now) noexcept {
  function.progress = Progress::running;
  function.number = image.word(function.value_device);
  function.step_index = 0;
  function.step_since = now;
  if (observer_ != nullptr) observer_->action_started(function.kind, function.number);
}

void MachineProgram::go_on(Function& function, Image& image, SteadyTime now) noexcept {
  if (function.progress != Progress::running) return;
  const std::span<const Step> steps = steps_of(function.kind, function.number);
  for (; function.step_index < steps.size(); ++function.step_index, function.step_since = now) {
    if (step_is_done(steps[function.step_index], function.number, image)) continue;
    if (now - function.step_since > step_time_max) raise_alarm(MachineAlarm::action_time_out, image);
    return;
  }
  function.progress = Progress::done;
  if (observer_ != nullptr) observer_->action_finished(function.kind, function.number);
}

/// The strobe is off: forgets the function, and stops what must not go on by itself. Spindle and coolant stay
/// as they are.
void MachineProgram::withdraw(Function& function, Image& image) noexcept {
  if (function.kind == FunctionKind::m && function.progress == Progress::running) {
    image.order(machine::tool_magazine, 0);
    image.order(machine::tool_clamp_release, 0);
  }
  function.progress = Progress::none;
}

std::span<const MachineProgram::Step> MachineProgram::steps_of(FunctionKind kind,
                                                               std::uint16_t number) noexcept {
  static constexpr Step all_off[] = {Step::coolant_off, Step::spindle_off};
  static constexpr Step clockwise_with_flood[] = {Step::spindle_clockwise, Step::flood_on};
  static constexpr Step counter_clockwise_with_flood[] = {Step::spindle_counter_clockwise, Step::flood_on};
  static constexpr Step spindle_off[] = {Step::spindle_off};
  static constexpr Step tool_change[] = {Step::spindle_off, Step::change_tool, Step::clamp_tool};
  static constexpr Step mist_on[] = {Step::mist_on};
  static constexpr Step coolant_off[] = {Step::coolant_off};
  static constexpr Step select_tool[] = {Step::select_tool};
  static constexpr Step set_speed[] = {Step::set_speed};

  if (kind == FunctionKind::s) return set_speed;
  if (kind == FunctionKind::t) return select_tool;
  switch (number) {
    case 0:
    case 1:
    case 2:
    case 30:
    case 60:
      return all_off;
    case 3:
      return std::span{clockwise_with_flood}.first(1);
    case 4:
      return std::span{counter_clockwise_with_flood}.first(1);
    case 5:
    case 19:
      return spindle_off;
    case 6:
      return tool_change;
    case 7:
      return mist_on;
    case 8:
      return std::span{clockwise_with_flood}.last(1);
    case 9:
      return coolant_off;
    case 13:
      return clockwise_with_flood;
    case 14:
      return counter_clockwise_with_flood;
    default:
      return {};  // nothing to do on this machine
  }
}

bool MachineProgram::step_is_done(Step step, std::uint16_t number, Image& image) noexcept {
  switch (step) {
    case Step::coolant_off:
      image.order(machine::flood_coolant, 0);
      image.order(machine::mist_coolant, 0);
      return image.confirms(!image.is_on(machine::flood_flow_switch) &&
                            !image.is_on(machine::mist_flow_switch));
    case Step::spindle_off:
      image.order(machine::spindle_clockwise, 0);
      image.order(machine::spindle_counter_clockwise, 0);
      return image.confirms(image.is_on(machine::zero_speed_switch));
    case Step::spindle_clockwise:
      return spindle_turns(image, machine::spindle_clockwise, machine::spindle_counter_clockwise);
    case Step::spindle_counter_clockwise:
      return spindle_turns(image, machine::spindle_counter_clockwise, machine::spindle_clockwise);
    case Step::flood_on:
      image.order(machine::flood_coolant, 1);
      return image.confirms(image.is_on(machine::flood_flow_switch));
    case Step::mist_on:
      image.order(machine::mist_coolant, 1);
      return image.confirms(image.is_on(machine::mist_flow_switch));
    case Step::change_tool:
      image.order(machine::tool_magazine, 1);
      image.order(machine::tool_clamp_release, 1);
      return image.confirms(image.is_on(machine::tool_changed_switch));
    case Step::clamp_tool:
      image.order(machine::tool_magazine, 0);
      image.order(machine::tool_clamp_release, 0);
      if (!image.confirms(!image.is_on(machine::tool_changed_switch))) return false;
      image.store(machine::tool_in_spindle, image.word(machine::selected_tool));
      return true;
    case Step::select_tool:
      image.store(machine::selected_tool, number);
      return true;
    case Step::set_speed:
      image.order(machine::spindle_speed, number);
      return !image.spindle_is_ordered() || image.confirms(image.is_on(machine::at_speed_switch));
  }
  return true;
}

bool MachineProgram::spindle_turns(Image& image, Device direction, Device opposite) noexcept {
  if (!image.is_on(machine::door_switch)) {
    raise_alarm(MachineAlarm::door_open, image);
    return false;
  }
  image.order(opposite, 0);
  // I3: a spindle that turns the other way, or is still running down, has to stand first.
  if (!image.is_on(direction) && !image.confirms(image.is_on(machine::zero_speed_switch))) return false;
  image.order(direction, 1);
  return image.confirms(image.is_on(machine::at_speed_switch));
}

void MachineProgram::raise_alarm(MachineAlarm alarm, Image& image) noexcept {
  alarm_ = alarm;
  abandon(image);
}

void MachineProgram::abandon(Image& image) noexcept {
  for (const Device output : moving_outputs) image.order(output, 0);
  for (Function& function : functions_) function.progress = Progress::none;
  handshake_ = Handshake::abandoned;
}

void MachineProgram::publish(Image& image) const noexcept {
  const bool alarm = alarm_ != MachineAlarm::none;
  const bool ready = !alarm && image.is_on(machine::emergency_stop_chain) &&
                     image.is_on(machine::door_switch) && !image.is_on(machine::reset);
  const bool at_speed = image.is_on(machine::at_speed_switch);
  const bool running = image.is_on(machine::program_running);
  const bool held = image.is_on(machine::feed_hold_active);

  image.store(machine::fin, handshake_ == Handshake::finished);
  image.store(machine::alarm, alarm);
  image.store(machine::alarm_number, static_cast<std::uint16_t>(alarm_));
  image.store(machine::emergency_stop_ok, image.is_on(machine::emergency_stop_chain));
  image.store(machine::spindle_at_speed, at_speed);
  image.store(machine::door_closed, image.is_on(machine::door_switch));
  image.store(machine::feed_enable, ready && (at_speed || !image.spindle_is_ordered()));
  image.store(machine::cycle_start_enable, ready);
  image.store(machine::green_lamp, !alarm && running && !held);
  image.store(machine::yellow_lamp, !alarm && (!running || held));
  image.store(machine::red_lamp, alarm);
}

}  // namespace emulator_models
