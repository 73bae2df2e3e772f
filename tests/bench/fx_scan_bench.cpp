// What a scan of FxPlc costs before the first instruction: ports, special devices, latch, outputs; and what the clocks
// of FxPlcLoop add to it.

#include <chrono>
#include <cstdlib>
#include <utility>

#include <benchmark/benchmark.h>

#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"

namespace {

using namespace emulator_models;
using namespace std::chrono_literals;

struct Scanned {
  Scanned() {
    auto compiled = soft_plc::compile("PROGRAM idle\nEND_PROGRAM\n", FxAddressMap{protocol::fx::Model::fx3u});
    if (!compiled) std::exit(1);
    program = std::move(*compiled);
  }

  static FxPlcConfig config() {
    FxPlcConfig config;
    config.period = 0ns;
    return config;
  }

  SteadyTime now{1h};
  FxPlcEmulator emulator{protocol::fx::Model::fx3u};
  ScanBoundaryPort port{emulator};
  soft_plc::IlProgram program;
  FxPlc plc{emulator, program, {}, &port, config(), now};
};

void scan_without_a_program(benchmark::State& state) {
  Scanned scanned;
  for (auto _ : state) {
    while (scanned.plc.advance(scanned.now, WallTime{scanned.now.time_since_epoch()}).action !=
           soft_plc::ScanAction::wait) {
    }
    scanned.now += 10us;
  }
}
BENCHMARK(scan_without_a_program);

void the_same_with_a_clock_read_for_each_step(benchmark::State& state) {
  Scanned scanned;
  for (auto _ : state) {
    const WallTime wall = std::chrono::system_clock::now();
    while (scanned.plc.advance(std::chrono::steady_clock::now(), wall).action != soft_plc::ScanAction::wait) {
    }
  }
}
BENCHMARK(the_same_with_a_clock_read_for_each_step);

}  // namespace

BENCHMARK_MAIN();
