// What recording costs: a record into the ring, the values of a scan, a whole scan with and without a recorder, and the
// archive's thread for a batch. Needs nothing of the simulated world.
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "emulator_models/archive/archive_database.hpp"
#include "emulator_models/fx_address_map.hpp"
#include "emulator_models/fx_plc.hpp"
#include "emulator_models/fx_recorder.hpp"
#include "emulator_models/soft_plc/il_compiler.hpp"

namespace {

using namespace emulator_models;
using namespace std::chrono_literals;
using protocol::fx::DeviceKind;
using protocol::fx::Model;
using soft_plc::EventRecord;
using soft_plc::EventRing;
using soft_plc::RealTimeValues;

constexpr std::size_t records_at_once = 1024;

/// Only the pushes are timed; what takes the records out of the ring is another thread's business.
void push_records(benchmark::State& state, std::size_t capacity) {
  EventRing ring{capacity};
  std::vector<EventRecord> taken(records_at_once);
  EventRecord record{.kind = soft_plc::EventKind::overrun};
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < records_at_once; ++i) {
      record.scan_number = i;
      benchmark::DoNotOptimize(ring.push(record));
    }
    state.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    ring.take(taken);
  }
  state.counters["push"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(records_at_once),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(push_records, ring_with_room, records_at_once)->UseManualTime();
BENCHMARK_CAPTURE(push_records, full_ring, EventRing::capacity_min)->UseManualTime();

void publish(benchmark::State& state) {
  const auto words = static_cast<std::size_t>(state.range(0));
  RealTimeValues values{words};
  std::vector<std::uint64_t> image(words, 1);
  std::uint64_t scan = 0;
  for (auto _ : state) values.publish({++scan, {}}, image);
}
BENCHMARK(publish)->Arg(64)->Arg(2560);

void read_values(benchmark::State& state) {
  const auto words = static_cast<std::size_t>(state.range(0));
  RealTimeValues values{words};
  std::vector<std::uint64_t> image(words);
  values.publish({1, {}}, image);
  soft_plc::ScanStamp stamp;
  for (auto _ : state) benchmark::DoNotOptimize(values.read(image, stamp));
}
BENCHMARK(read_values)->Arg(64)->Arg(2560);

enum class Watched { by_nobody, by_a_recorder, with_signals_and_values };

/// A scan of 200 rungs, in simulated time.
void fx_scan(benchmark::State& state, Watched watched) {
  std::string source = "PROGRAM rungs VAR a AT M0 : BOOL; b AT M1 : BOOL; END_VAR\n";
  for (int i = 0; i < 200; ++i) source += "LD a\nANDN b\nST b\n";
  const auto program = soft_plc::compile(source + "END_PROGRAM\n", FxAddressMap{Model::fx3u});
  if (!program) return state.SkipWithError("program");
  FxRecorderConfig config;
  if (watched == Watched::with_signals_and_values) {
    for (std::uint16_t i = 0; i < 100; ++i) config.signals.push_back({DeviceKind::m, i});
    for (std::uint16_t i = 0; i < 64; ++i) config.values.push_back({DeviceKind::d, i});
  }
  SteadyTime now{1h};
  FxPlcEmulator emulator{Model::fx3u};
  FxPlc plc{emulator, *program, {}, nullptr, {}, now};
  FxRecorder recorder{config, Model::fx3u, now};
  if (watched != Watched::by_nobody) plc.observe_with(&recorder);
  for (auto _ : state) {
    while (plc.advance(now, {}).action != soft_plc::ScanAction::wait) {
    }
    now += 10ms;
  }
}
BENCHMARK_CAPTURE(fx_scan, watched_by_nobody, Watched::by_nobody);
BENCHMARK_CAPTURE(fx_scan, with_a_recorder, Watched::by_a_recorder);
BENCHMARK_CAPTURE(fx_scan, with_100_signals_and_64_values, Watched::with_signals_and_values);

/// On the archive's thread, in the folder for temporary files.
void append_a_batch(benchmark::State& state) {
  const auto file = std::filesystem::temp_directory_path() / ("archive_bench." + std::to_string(getpid()));
  const std::vector<EventRecord> batch(static_cast<std::size_t>(state.range(0)), EventRecord{.code = 1});
  {
    auto archive = archive::ArchiveDatabase::open({.file = file, .rows_max = 100'000});
    if (!archive) return state.SkipWithError(archive.error().message.c_str());
    for (auto _ : state) {
      if (!archive->append(batch)) return state.SkipWithError("append");
    }
  }
  for (const char* const suffix : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + suffix);
  state.counters["rows/s"] = benchmark::Counter(static_cast<double>(state.iterations() * state.range(0)),
                                                benchmark::Counter::kIsRate);
}
BENCHMARK(append_a_batch)->Arg(1)->Arg(100)->Arg(4096)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
