#include "emulator_models/fx_plc.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "emulator_models/latched_ranges.hpp"
#include "protocol/check.hpp"

namespace emulator_models {
namespace {

using namespace std::chrono_literals;
using protocol::fx::Device;
using protocol::fx::DeviceKind;
using soft_plc::FaultCode;
using soft_plc::Progress;
using soft_plc::ScanAction;
using soft_plc::StartKind;
using std::chrono::nanoseconds;

constexpr Device special_m(std::uint16_t number) noexcept { return {DeviceKind::m, number}; }
constexpr Device word(std::uint16_t number) noexcept { return {DeviceKind::d, number}; }

constexpr Device any_error = special_m(8004);
constexpr Device memory_hold = special_m(8033);
constexpr Device all_outputs_off = special_m(8034);
constexpr std::uint16_t hardware_error_number = 8061;
constexpr std::uint16_t operation_error_number = 8067;
constexpr Device operation_error_line = word(8069);
constexpr std::uint32_t watchdog_error = 6105;
constexpr std::uint32_t value_error = 6706;    ///< a value that the instruction does not take
constexpr std::uint32_t endless_error = 6709;  ///< other: instructions without an end
constexpr Device first_analog_input = word(200);
constexpr Device first_analog_output = word(210);

soft_plc::ScanConfig scan_config(nanoseconds period) noexcept {
  return {.period = period, .exchanges_with_cycles = false};
}

soft_plc::ScanTask make_task(const FxPlcConfig& config, SteadyTime now) {
  const auto task = soft_plc::ScanTask::make(scan_config(config.period), now.time_since_epoch());
  PLC_CHECK(task.has_value());
  return *task;
}

}  // namespace

FxPlc::FxPlc(FxPlcEmulator& emulator, const soft_plc::IlProgram& program, Plant plant, ScanBoundaryPort* port,
             const FxPlcConfig& config, SteadyTime now)
    : emulator_{emulator},
      machine_{program},
      plant_{std::move(plant)},
      port_{port},
      config_{config},
      task_{make_task(config, now)},
      period_{config.period},
      now_{now} {
  const auto locked = emulator_.lock();
  analog_inputs_index_ = locked->place_of(first_analog_input).byte_index;
  analog_outputs_index_ = locked->place_of(first_analog_output).byte_index;
  if (config.watchdog_limit)
    locked->set(watchdog_time, static_cast<std::uint32_t>(config.watchdog_limit->count()));
}

void FxPlc::observe_with(FxPlcObserver* observer) noexcept {
  observer_ = observer;
  if (port_ != nullptr) port_->observe_with(observer);
}

soft_plc::ScanStep FxPlc::advance(SteadyTime now, WallTime wall) noexcept {
  now_ = now;
  wall_ = wall;
  if (is_overdue()) task_.halt(FaultCode::watchdog);
  const soft_plc::ScanStep step = task_.next(now.time_since_epoch(), last_progress_);
  last_progress_ = Progress::finished;
  if (observer_ != nullptr) observer_->step_ordered(*this, locked_ ? &memory() : nullptr, now);
  if (step.action == ScanAction::wait) {
    locked_.reset();
    return step;
  }
  if (!locked_) locked_.emplace(emulator_.lock());
  first_scan_of_run_ = step.first_scan;
  last_progress_ = perform(step, *this);
  return step;
}

void FxPlc::system_analysis() noexcept {
  const bool power_up = !power_up_;
  if (power_up) power_up_ = now_;
  if (port_ != nullptr) port_->serve(*locked_);
  order_mode(power_up);
  show_times(power_up);
  set_period();
  // 0 would switch the watchdog's limit, not the watchdog, off: it counts as the shortest.
  watchdog_limit_ = std::max<nanoseconds>(std::chrono::milliseconds{memory().get(watchdog_time)}, 1ms);
  task_.set_watchdog_limit(watchdog_limit_);
}

bool FxPlc::is_overdue() const noexcept {
  return task_.mode() == soft_plc::RunMode::run && !task_.is_in_scan() &&
         now_.time_since_epoch() - task_.period().due() > watchdog_limit_;
}

void FxPlc::order_mode(bool power_up) noexcept {
  const bool switch_changed = std::exchange(run_switch_seen_, run_switch_) != run_switch_;
  const bool is_running = task_.mode() == soft_plc::RunMode::run;
  const bool switched_on = (power_up || switch_changed) && run_switch_;
  const bool stays = is_running && !(switch_changed && !run_switch_);
  if (!obey_remote_switch(memory(), stays || switched_on)) {
    if (is_running) task_.order_stop();
    return;
  }
  if (is_running) return;
  task_.order_reset();
  const bool cold = std::exchange(cold_start_ordered_, false) || power_up;
  [[maybe_unused]] const bool accepted = task_.order_run(cold ? StartKind::cold : config_.start);
}

void FxPlc::set_period() noexcept {
  const nanoseconds period = memory().get(constant_scan) != 0
                                 ? std::chrono::milliseconds{memory().get(constant_scan_time)}
                                 : config_.period;
  if (std::exchange(period_, period) != period) task_.reconfigure(scan_config(period));
}

void FxPlc::show_times(bool power_up) noexcept {
  // Nobody else can write clock flags and calendar, and to work them out takes longer than all else between two scans.
  const nanoseconds since_power_up = now_ - *power_up_;
  const std::int64_t clock_step = since_power_up / clock_flags_step;
  if (std::exchange(clock_step_, clock_step) != clock_step) set_clock_flags(memory(), since_power_up);
  const auto second = std::chrono::floor<std::chrono::seconds>(wall_);
  if (std::exchange(calendar_second_, second) != second) set_calendar(memory(), second);
  const soft_plc::ScanTimes& times = task_.scan_times();
  if (power_up || times.scans_count == 0) return;
  const auto units = [](nanoseconds time) {
    return static_cast<std::uint32_t>(std::min<std::int64_t>(time / 100us, 0xFFFF));
  };
  memory().set(word(8010), units(times.now));
  memory().set(word(8011), units(times.shortest));
  memory().set(word(8012), units(times.longest));
}

void FxPlc::initialise(StartKind start) noexcept {
  const bool cold = start == StartKind::cold;
  machine_.start(cold ? soft_plc::IlMachine::Start::cold : soft_plc::IlMachine::Start::warm);
  // At power-up the memory is clear, but for what a request has written before the first scan.
  if (std::exchange(has_run_, true) && cold) clear_all_but_special(memory());
}

void FxPlc::read_inputs() noexcept {
  const bool runs = task_.mode() == soft_plc::RunMode::run;
  set_run_flags(memory(), !runs                ? RunMode::stop
                          : first_scan_of_run_ ? RunMode::first_run_scan
                                               : RunMode::run);
  if (plant_) plant_(terminals_, now_);
  copy_points(terminals_.inputs, memory().inputs());
  std::memcpy(memory().bytes().data() + analog_inputs_index_, terminals_.analog_inputs.data(),
              sizeof terminals_.analog_inputs);
}

Progress FxPlc::execute(const soft_plc::ScanStep& step) noexcept {
  const auto end =
      machine_.run_slice({memory().inputs(), memory().outputs(), memory().bytes()}, step.scan_start,
                         config_.slice_instructions, config_.scan_instructions_max);
  if (end) return *end == soft_plc::SliceEnd::scan ? Progress::finished : Progress::unfinished;
  program_fault_ = end.error();
  return Progress::failed;
}

void FxPlc::write_outputs() noexcept {
  if (memory().get(all_outputs_off) != 0) {
    terminals_.outputs.reset();
    terminals_.analog_outputs.fill(0);
    return;
  }
  terminals_.outputs = points_of(memory().outputs());
  std::memcpy(terminals_.analog_outputs.data(), memory().bytes().data() + analog_outputs_index_,
              sizeof terminals_.analog_outputs);
}

void FxPlc::write_safe_outputs() noexcept {
  terminals_.outputs.reset();
  terminals_.analog_outputs.fill(0);
  machine_.abandon_scan();
  // What a stopped program said of the machine is true no longer: who polls its devices must not go by them.
  if (memory().get(memory_hold) == 0) clear_unlatched(memory());
}

void FxPlc::set_alarm_lamp(bool on) noexcept {
  const bool program = on && task_.fault()->code == FaultCode::program_failed;
  cpu_error_lamp_ = on && !program;
  program_error_lamp_ = program;
  if (!program) program_fault_.reset();
  const std::uint32_t program_error =
      program && program_fault_->kind == soft_plc::FaultKind::budget_spent ? endless_error : value_error;
  const std::uint32_t line = program ? program_fault_->place.line : 0;
  DeviceMemory& devices = memory();
  devices.set(special_m(hardware_error_number), cpu_error_lamp_);
  devices.set(word(hardware_error_number), cpu_error_lamp_ ? watchdog_error : 0);
  devices.set(special_m(operation_error_number), program);
  devices.set(word(operation_error_number), program ? program_error : 0);
  devices.set(operation_error_line, line);
  devices.set(any_error, on);
  if (!on) return;
  set_run_flags(devices, RunMode::stop);
  // An order of RUN that was given before the fault does not clear it.
  for (std::uint16_t number = 8035; number <= 8037; ++number) devices.set(special_m(number), 0);
}

}  // namespace emulator_models
