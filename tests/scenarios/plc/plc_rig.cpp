#include "tests/scenarios/plc/plc_rig.hpp"

#include <array>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "emulator_models/soft_plc/plc_threads.hpp"
#include "tests/scenarios/plc/plc_clocks.hpp"
#include "tests/scenarios/plc/watched_body.hpp"

namespace scenarios::soft_plc {
namespace {

using namespace std::chrono_literals;
using emulator_models::soft_plc::GatewayItem;
using emulator_models::soft_plc::GatewayRequest;
using emulator_models::soft_plc::IoManager;
using emulator_models::soft_plc::OverrunRule;
using emulator_models::soft_plc::PlcClock;
using emulator_models::soft_plc::PlcThreading;
using emulator_models::soft_plc::PlcThreads;
using emulator_models::soft_plc::ScanPeriod;
using emulator_models::soft_plc::SoftPlc;
using emulator_models::soft_plc::SoftPlcSetup;
using emulator_models::soft_plc::StartKind;

std::unique_ptr<PlcClock> make_clock(PlcScene::Clock kind) {
  if (kind == PlcScene::Clock::wall) return std::make_unique<WallPlcClock>();
  if (kind == PlcScene::Clock::milliseconds_32) return std::make_unique<MillisecondPlcClock>();
  return std::make_unique<emulator_models::soft_plc::SteadyPlcClock>();
}

WatchedBody::Hang choose_hang(ltsim::World& world, const PlcScene& scene) {
  using Trouble = WatchedBody::Trouble;
  const auto duration = scene.watchdog_limit + scene.watchdog_limit / 6;
  if (scene.hang == PlcScene::Hang::never) return {};
  if (scene.hang == PlcScene::Hang::second_scan)
    return {Trouble::hangs_in_slice, 2, duration, scene.realtime};
  const auto trouble = static_cast<Trouble>(world.choose("hang", 3));
  return {trouble, 1 + world.choose("hangs-in-scan", 4), duration, scene.realtime};
}

/// One exchange of the first 16 has the trouble.
std::function<SharedMemoryDriver::Trouble()> choose_trouble(ltsim::World& world, const PlcScene& scene) {
  using Trouble = SharedMemoryDriver::Trouble;
  if (scene.realtime) return [number = 0]() mutable { return number++ == 0 ? Trouble::late : Trouble::none; };
  if (!scene.driver_may_fail) return [] { return Trouble::none; };
  const auto trouble = static_cast<Trouble>(world.choose("driver", 3));
  return [trouble, number = world.choose("driver-exchange", 16)]() mutable {
    return number-- == 0 ? trouble : Trouble::none;
  };
}

/// Where between two scans the driver works is a matter of when it began.
std::chrono::microseconds choose_lateness(ltsim::World& world, const PlcScene& scene) {
  if (!scene.realtime) return 12ms;
  return 1us + scene.period / 2 * static_cast<int>(world.choose("phase", 100)) / 100;
}

SoftPlcSetup make_setup(ltsim::World& world, const PlcScene& scene, PlcMonitor& monitor) {
  SoftPlcSetup setup;
  setup.slice_intervals = {0ns};
  const WatchedBody::Hang hang = choose_hang(world, scene);
  for (std::size_t i = 0; i < PlcMonitor::cycles_count; ++i) {
    setup.cycles.push_back(
        {.name = i == 0 ? "fast" : "slow",
         .config = {.scan = {.period = scene.period * static_cast<int>(1 + i),
                             .overrun = scene.catches_up ? OverrunRule::catch_up : OverrunRule::skip,
                             .watchdog_limit = scene.watchdog_limit}},
         .sends = {},
         .body =
             std::make_unique<WatchedBody>(monitor, i, scene.inputs, i == 0 ? hang : WatchedBody::Hang{})});
  }
  IoManager::Slot& card = setup.drivers.emplace_back();
  card.config.name = "card";
  card.config.inputs = {0, 8};
  card.config.period = scene.period / 2;
  card.driver = std::make_unique<SharedMemoryDriver>(monitor, scene.driver, choose_trouble(world, scene),
                                                     choose_lateness(world, scene));
  return setup;
}

void stop(SoftPlc& plc, PlcMonitor& monitor) {
  plc.order_stop();
  monitor.stop_ordered();
}

void start(SoftPlc& plc, PlcMonitor& monitor) {
  if (plc.order_run(StartKind::cold)) monitor.run_ordered();
}

void acknowledge(SoftPlc& plc, PlcMonitor& monitor) {
  stop(plc, monitor);
  static_cast<void>(plc.order_reset());
  start(plc, monitor);
}

void give_order(ltsim::World& world, SoftPlc& plc, PlcMonitor& monitor) {
  const std::size_t order = world.choose("order", 3);
  if (order == 0) return;
  stop(plc, monitor);
  if (order == 1) start(plc, monitor);
}

/// The operator, who resets and starts again a PLC that shows a fault.
void operate(ltsim::World& world, const PlcScene& scene, SoftPlc& plc, PlcMonitor& monitor) {
  const bool gives_orders = scene.panel == PlcScene::Operator::gives_orders;
  start(plc, monitor);
  for (unsigned i = 0; i < scene.orders; ++i) {
    std::this_thread::sleep_for((1 + (gives_orders ? world.choose("pause", 4) : 0)) * scene.period * 3 / 4);
    if (plc.alarm_lamp()) {
      acknowledge(plc, monitor);
    } else if (gives_orders) {
      give_order(world, plc, monitor);
    }
  }
  std::this_thread::sleep_for(2 * scene.period);
  plc.stop_now();
  monitor.stopped();
}

GatewayRequest make_request(std::size_t cycle, std::uint64_t value) {
  std::vector<std::byte> word(sizeof value);
  std::memcpy(word.data(), &value, sizeof value);
  const auto write = [&](std::size_t first) {
    return GatewayItem{.section = {first, word.size()}, .written = word};
  };
  const auto read = [](std::size_t first) { return GatewayItem{.section = {first, 16}, .written = {}}; };
  return {.cycle = cycle, .items = {write(16), write(24), read(0), read(16)}};
}

std::array<std::uint64_t, 2> words_in(const std::vector<std::byte>& read) {
  std::array<std::uint64_t, 2> words{};
  std::memcpy(words.data(), read.data(), sizeof words);
  return words;
}

/// A field device: each request writes the pair of words that is there for it, and reads both pairs.
void ask(ltsim::World& world, const PlcScene& scene, SoftPlc& plc, PlcMonitor& monitor,
         std::uint64_t device) {
  for (std::uint64_t i = 1; i <= scene.field_requests; ++i) {
    const std::uint64_t value = device << 32U | i;
    const std::size_t cycle = world.choose("asked-cycle", PlcMonitor::cycles_count);
    const auto answer = plc.gateway().exchange(make_request(cycle, value), scene.period);
    if (answer) {
      monitor.gateway_answered(value, words_in(answer->read[2]), words_in(answer->read[3]));
    } else {
      monitor.gateway_given_up(value);
    }
  }
}

void run_plc(ltsim::World& world, const PlcScene& scene, PlcMonitor& monitor) {
  const auto inner = make_clock(scene.clock);
  const auto clock = std::make_unique<WatchedPlcClock>(monitor, *inner);
  const auto plc = SoftPlc::make(make_setup(world, scene, monitor), clock->now()).value();
  monitor.set_lamp([&plc] { return plc->alarm_lamp(); });
  PlcThreads threads{
      *plc, *clock, scene.threading == PlcScene::Threading::one ? PlcThreading::one : PlcThreading::per_cycle,
      scene.realtime};
  std::vector<std::thread> devices;
  for (std::uint64_t device = 1; scene.field_requests > 0 && device <= 2; ++device)
    devices.emplace_back([&, device] { ask(world, scene, *plc, monitor, device); });
  operate(world, scene, *plc, monitor);
  for (std::thread& device : devices) device.join();
  monitor.set_lamp({});  // the watchdog ends, and the outputs are safe
  threads.stop();
}

void move_inputs(const PlcScene& scene) {
  const Card card{card_segment};
  for (std::uint64_t value = 1; value <= 6; ++value) {
    card->inputs = value;
    std::this_thread::sleep_for(scene.period / 2);
  }
}

}  // namespace

void run_scene(ltsim::World& world, const PlcScene& scene) {
  if (scene.realtime) world.set_cpu(ltsim::Cpu::one_fifo);
  world.name_region(card_segment, 0, 8, "card.inputs");
  world.name_region(card_segment, 8, 8, "card.outputs");
  PlcMonitor monitor{world,
                     {.periods = {scene.period, 2 * scene.period},
                      .watchdog_limit = scene.watchdog_limit,
                      .burst = scene.catches_up ? static_cast<std::uint64_t>(ScanPeriod::catch_up_max) : 0,
                      .only = scene.only}};
  if (scene.stalls > 0) world.process("plc").may_stall(scene.stalls);
  if (scene.clock_steps > 0) world.grant(ltsim::FaultKind::clock_step, scene.clock_steps);
  world.whenever_idle([&] { monitor.idle(); });
  world.process("plc").start("main", [&] { run_plc(world, scene, monitor); });
  world.process("field").start("main", [&] { move_inputs(scene); });
  world.run();
}

}  // namespace scenarios::soft_plc
