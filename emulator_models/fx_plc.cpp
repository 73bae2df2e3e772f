#include "emulator_models/fx_plc.hpp"

#include <algorithm>
#include <utility>

#include "emulator_models/latched_ranges.hpp"
#include "protocol/check.hpp"
#include "protocol/fx/device_ranges.hpp"

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
constexpr std::uint16_t hardware_error_number = 8061;
constexpr std::uint16_t operation_error_number = 8067;
constexpr Device operation_error_line = word(8069);
constexpr std::uint32_t watchdog_error = 6105;
constexpr std::uint32_t value_error = 6706;    ///< a value that the instruction does not take
constexpr std::uint32_t endless_error = 6709;  ///< other: instructions without an end
constexpr std::uint16_t first_analog_input = 200;
constexpr std::uint16_t first_analog_output = 210;

soft_plc::ScanTask make_task(const FxPlcConfig& config, SteadyTime now) {
  const auto task = soft_plc::ScanTask::make({.period = config.period, .exchanges_with_cycles = false},
                                             now.time_since_epoch());
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
      now_{now} {
  if (config.watchdog_limit)
    emulator_.lock()->set(watchdog_time, static_cast<std::uint32_t>(config.watchdog_limit->count()));
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

void FxPlc::show_times(bool power_up) noexcept {
  set_clock_flags(memory(), now_ - *power_up_);
  set_calendar(memory(), wall_);
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
  const std::uint16_t inputs_count = protocol::fx::ranges_of(memory().model()).x;
  const std::span<std::byte> image = memory().inputs();
  for (std::size_t i = 0; i < image.size(); ++i) {
    unsigned byte = 0;
    for (std::size_t bit = 0; bit < 8 && 8 * i + bit < inputs_count; ++bit)
      byte |= unsigned{terminals_.inputs[8 * i + bit]} << bit;
    image[i] = static_cast<std::byte>(byte);
  }
  for (std::uint16_t i = 0; i < terminals_.analog_inputs.size(); ++i)
    memory().set(word(static_cast<std::uint16_t>(first_analog_input + i)), terminals_.analog_inputs[i]);
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
  if (memory().get(special_m(8034)) != 0) {
    terminals_.outputs.reset();
    terminals_.analog_outputs.fill(0);
    return;
  }
  const std::uint16_t outputs_count = protocol::fx::ranges_of(memory().model()).y;
  const std::span<const std::byte> image = memory().outputs();
  for (std::size_t i = 0; i < outputs_count; ++i)
    terminals_.outputs[i] = (std::to_integer<unsigned>(image[i / 8]) >> (i % 8) & 1U) != 0;
  for (std::uint16_t i = 0; i < terminals_.analog_outputs.size(); ++i)
    terminals_.analog_outputs[i] =
        static_cast<std::uint16_t>(memory().get(word(static_cast<std::uint16_t>(first_analog_output + i))));
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
