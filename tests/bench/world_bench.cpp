// How fast the simulated world is: executions and scheduling points a second, on one core.
//
// Absolute figures differ from machine to machine and from hour to hour; "switches" relates each to the bare
// switch between two contexts, measured in the same run: a scheduling point costs so many of them. What the
// checks of memory cost (races, changes unseen, coverage) shows beside "unchecked".
//
// Where an execution of "handoff_unchecked" goes, in instructions that callgrind counts (12,100, gcc 12 -O3):
//   33 %  its 25 scheduling points: 162 each, the choice and the switch to the other task included
//   26 %  semaphores and segments, opened by name, mapped, closed: what replaces libc's calls and Linux's
//   15 %  the code under test with Boost.Interprocess (8 %), and the announcements of its plain accesses (7 %)
//   11 %  two processes and their tasks: made, named, begun, ended
//    6 %  eight accesses to the segment, besides their scheduling points
//    9 %  begin and end of the execution, blocking and waking, all else
// Its profile is flat. Time goes to what is not foreseen, too: whom the random walk chooses is one bit a point, and after a
// switch each return to a function that the other task is not in.

#include <chrono>

#include <benchmark/benchmark.h>

#include "sim_clock/check/self_check.hpp"
#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/random_strategy.hpp"

namespace {

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

/// A context that does nothing but switch back.
class PingPong {
 public:
  PingPong() {
    main_.adopt_current();
    other_.prepare(storage_.stack_top(), storage_.thread_pointer(), &switch_back, this);
  }

  void round_trip() noexcept { ltsim::Context::switch_between(main_, other_); }

 private:
  static void switch_back(void* self) {
    auto& pair = *static_cast<PingPong*>(self);
    for (;;) ltsim::Context::switch_between(pair.other_, pair.main_);
  }

  ltsim::TaskStorage storage_;
  ltsim::Context main_;
  ltsim::Context other_;
};

double seconds_per_switch() {
  static const double seconds = [] {
    PingPong pair;
    constexpr int round_trips = 2'000'000;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < round_trips; ++i) pair.round_trip();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() /
           (2.0 * round_trips);
  }();
  return seconds;
}

void context_switch(benchmark::State& state) {
  PingPong pair;
  for (auto _ : state) pair.round_trip();
  state.counters["switches/s"] =
      benchmark::Counter(2.0 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(context_switch);

void scenario(benchmark::State& state, const char* name, bool checks,
              ltsim::Memory memory = ltsim::Memory::sc) {
  world().set_checks(checks);
  world().set_default_memory(memory);
  const ltsim::Scenario* const found = ltsim::find_scenario(name);
  LTSIM_CHECK(found != nullptr);
  ltsim::Explorer explorer{world()};
  ltsim::RandomStrategy strategy;
  std::uint64_t seed = 0;
  std::uint64_t points = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (auto _ : state) {
    explorer.execute(*found, strategy, ++seed, nullptr);
    points += world().scheduler().points();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto executions = static_cast<double>(state.iterations());
  state.counters["executions/s"] = benchmark::Counter(executions, benchmark::Counter::kIsRate);
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
  state.counters["points"] = static_cast<double>(points) / executions;
  state.counters["switches/point"] = seconds / static_cast<double>(points) / seconds_per_switch();
}
BENCHMARK_CAPTURE(scenario, handoff, "bench/handoff", true);
BENCHMARK_CAPTURE(scenario, handoff_unchecked, "bench/handoff", false);
BENCHMARK_CAPTURE(scenario, hundred_handoffs, "bench/hundred-handoffs", true);
BENCHMARK_CAPTURE(scenario, hundred_handoffs_unchecked, "bench/hundred-handoffs", false);
BENCHMARK_CAPTURE(scenario, hundred_handoffs_c11, "bench/hundred-handoffs", true, ltsim::Memory::c11);
BENCHMARK_CAPTURE(scenario, one_request, "paper/one-request", true);
BENCHMARK_CAPTURE(scenario, three_requests, "paper/three-requests", true);
BENCHMARK_CAPTURE(scenario, three_requests_c11, "paper/three-requests", true, ltsim::Memory::c11);
BENCHMARK_CAPTURE(scenario, three_requests_unchecked, "paper/three-requests", false);
BENCHMARK_CAPTURE(scenario, part_program, "nc/part-program", true);
BENCHMARK_CAPTURE(scenario, part_program_unchecked, "nc/part-program", false);

}  // namespace

BENCHMARK_MAIN();
