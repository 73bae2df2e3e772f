#include "tests/scenarios/propulsion/propulsion_scene.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <thread>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/plants/propulsion_devices.hpp"
#include "kernel_mocks/fx_driver.hpp"
#include "kernel_mocks/plc_signals.hpp"
#include "protocol/shared_memory_port_manager.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "tests/scenarios/propulsion/watched_propulsion.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace scenarios {
namespace {

using namespace std::chrono_literals;
using emulator_models::PropulsionFailure;
using emulator_models::PropulsionPlant;
using kernel_mocks::FxDriver;
using protocol::PaperOptions;
namespace wire = emulator_models::propulsion;

constexpr auto scan_period = 10ms;
constexpr std::chrono::seconds watch_length = 100s;
constexpr auto polling_interval = 250ms;
/// Longer than the pressure needs, and the change of a pump.
constexpr auto pressure_wait = 3s;
constexpr auto press_length = 300ms;
constexpr std::uint64_t points_max = 20'000'000;

/// In 0.1 %; the last ones of a station that does not look at what it is given.
constexpr std::array<std::int16_t, 8> orders{0, 200, 500, 1000, -300, -1000, 1500, -3000};
constexpr std::array<std::int16_t, 9> lever_positions{0, 27, -27, 100, 400, 1000, -100, -600, -1000};
constexpr std::array<std::chrono::milliseconds, 5> pauses{200ms, 500ms, 1s, 3s, 8s};
constexpr std::array<std::int32_t, 3> sea_loads{100, 300, 600};

template <typename Values>
auto chosen(ltsim::World& world, std::string_view what, const Values& values) {
  return values[world.choose(what, values.size())];
}

/// The PC: one poll after the other, its heartbeat with each, and what its operator wants.
class Station {
 public:
  Station(ltsim::World& world, FxDriver& driver) : world_{world}, driver_{driver} {}

  void poll() {
    // Lamps and outputs in two bytes, and the measured values; what it shows nobody needs here.
    std::array<std::byte, 2> outputs{};
    (void)driver_.read_bytes(wire::pump_1, outputs);
    if (silent_polls_ > 0) {
      --silent_polls_;
    } else {
      write(wire::pc_heartbeat, ++heartbeat_);
    }
    release();
  }

  void act() {
    switch (world_.choose("station", 16)) {
      case 1:
      case 2:
        return write(wire::pc_order, static_cast<std::uint16_t>(chosen(world_, "order", orders)));
      case 3:
      case 4:
        return toggle(wire::pc_remote, remote_);
      case 5:
        return press(wire::pc_start);
      case 6:
        return press(wire::pc_acknowledge);
      case 7:
        return toggle(wire::pc_stop, stop_);
      case 8:
        return toggle(wire::pc_pumps, pumps_);
      case 9:
        return toggle(wire::duty_is_pump_2, duty_is_pump_2_);
      case 10:
        // Its program hangs, its port still writes.
        silent_polls_ = static_cast<unsigned>(chosen(world_, "silence", pauses) * 4 / polling_interval);
        return;
      case 11:
        return turn_plc(world_.choose("plc", 4) != 0);
      default:
        return;
    }
  }

 private:
  void write(wire::Device word, std::uint16_t value) { (void)driver_.write_words(word, {&value, 1}); }
  void toggle(wire::Device bit, bool& state) { (void)driver_.force(bit, state = !state); }
  /// Until the next poll.
  void press(wire::Device bit) {
    (void)driver_.force(bit, true);
    pressed_ = bit;
  }
  void release() {
    if (pressed_) (void)driver_.force(*pressed_, false);
    pressed_.reset();
  }
  void turn_plc(bool run) {
    using namespace kernel_mocks::signals;
    if (!run) return (void)driver_.force(plc_forced_stop, true);
    (void)driver_.force(plc_forced_mode, true);
    (void)driver_.force(plc_forced_run, true);
  }

  ltsim::World& world_;
  FxDriver& driver_;
  std::uint16_t heartbeat_ = 0;
  unsigned silent_polls_ = 0;
  std::optional<wire::Device> pressed_;
  bool remote_ = false;
  bool stop_ = false;
  bool pumps_ = false;
  bool duty_is_pump_2_ = false;
};

void run_station(ltsim::World& world, const PaperOptions& paper, const std::atomic<bool>& over) {
  protocol::SharedMemoryPortManager ports{paper};
  const auto port = ports.port("handoff");
  if (!port) return;
  FxDriver driver{**port, {}};
  if (!driver.connect()) return;
  Station station{world, driver};
  // A plant whose people are always busy gets nowhere: in some watches the station only looks on.
  const bool operator_is_busy = world.choose("station-busy", 2) != 0;
  while (!over.load()) {
    station.poll();
    if (operator_is_busy) station.act();
    std::this_thread::sleep_for(polling_interval);
  }
}

/// The people on the bridge and in the engine room, and what the sea and wear do.
class Crew {
 public:
  Crew(ltsim::World& world, PropulsionPlant& plant) : world_{world}, plant_{plant} {}

  void act() {
    switch (world_.choose("hand", 16)) {
      case 0:
      case 1:
        return get_under_way();
      case 2:
      case 3:
      case 4:
        return plant_.move_lever(chosen(world_, "lever", lever_positions));
      case 5:
        return press(&PropulsionPlant::press_acknowledge);
      case 6:
        return press(&PropulsionPlant::press_stop);
      case 7:
        return plant_.press_start(start_ = !start_);
      case 8:
        return plant_.set_local_switch(local_ = !local_);
      case 9:
        return plant_.set_pumps_switch(pumps_ = !pumps_);
      case 10:
        return plant_.set_sea_load(chosen(world_, "sea", sea_loads));
      case 11:
      case 12:
      case 13:
        return fail_or_repair();
      default:
        return;
    }
  }

  void rest() { std::this_thread::sleep_for(chosen(world_, "pause", pauses)); }

 private:
  void press(void (PropulsionPlant::*button)(bool) noexcept) {
    (plant_.*button)(true);
    std::this_thread::sleep_for(press_length);
    (plant_.*button)(false);
  }

  void get_under_way() {
    plant_.move_lever(0);
    plant_.set_pumps_switch(pumps_ = true);
    std::this_thread::sleep_for(pressure_wait);
    press(&PropulsionPlant::press_start);
    start_ = false;
    plant_.move_lever(chosen(world_, "lever", lever_positions));
  }

  /// At most two things are broken at once.
  void fail_or_repair() {
    std::optional<PropulsionFailure>& failure = failures_[world_.choose("which", failures_.size())];
    if (failure) {
      plant_.set_failure(*failure, false);
      failure.reset();
      return;
    }
    failure =
        static_cast<PropulsionFailure>(world_.choose("failure", emulator_models::propulsion_failures_count));
    plant_.set_failure(*failure, true);
  }

  ltsim::World& world_;
  PropulsionPlant& plant_;
  std::array<std::optional<PropulsionFailure>, 2> failures_;
  bool start_ = false;
  bool local_ = false;
  bool pumps_ = false;
};

}  // namespace

void keep_watch(ltsim::World& world, const emulator_models::soft_plc::IlProgram& program,
                std::string_view only_rule) {
  PaperOptions paper;
  paper.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  name_regions(world, "handoff", paper);
  world.set_points_max(points_max);

  WatchedPropulsion propulsion{world, program, scan_period, only_rule};
  protocol::SlaveSharedMemoryWrapper slave{"handoff", paper};
  emulator_models::EmulatorHandler handler{slave, propulsion.port()};
  std::atomic<bool> over{false};

  world.process("station").start("main", [&] {
    run_station(world, paper, over);
    handler.request_stop();
    propulsion.request_stop();
  });
  world.process("emulator").start("port", [&] {
    if (slave.open()) handler.run();
  });
  world.process("emulator").start("scan", [&] { propulsion.scan(); });
  world.process("ship").start("crew", [&] {
    Crew crew{world, propulsion.plant()};
    const auto end = std::chrono::steady_clock::now() + watch_length;
    while (std::chrono::steady_clock::now() < end) {
      crew.act();
      crew.rest();
    }
    over.store(true);
  });
  world.run();
}

}  // namespace scenarios
