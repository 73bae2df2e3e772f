// How fast compiled instruction list runs: instructions of boolean rungs a second, on one core.
//
// The rungs differ from each other, and long programs take more than the first caches hold: what is measured is
// the fetch and the dispatch, not a loop learnt by heart. Needs nothing of the simulated world.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <benchmark/benchmark.h>

#include "emulator_models/soft_plc/il_compiler.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"

namespace {

using namespace emulator_models::soft_plc;

IlProgram compiled(const std::string& source) {
  auto program = compile(source);
  if (!program) {
    std::fprintf(stderr, "%s\n", to_string(program.error()).c_str());
    std::exit(1);
  }
  return std::move(*program);
}

/// Four shapes of rung, mixed, over all bits of the images.
std::string rungs(int count) {
  std::string source = "PROGRAM bench VAR a, b, c, d, motor, lamp : BOOL; END_VAR\n";
  for (int rung = 0; rung < count; ++rung) {
    const std::string in = "%IX" + std::to_string(rung % 64) + "." + std::to_string(rung % 8);
    const std::string out = "%QX" + std::to_string(rung * 7 % 64) + "." + std::to_string(rung * 3 % 8);
    source.append("LD ").append(in).append("\nOR motor\nANDN ").append(out).append("\nST motor\n");
    if (rung % 2 == 0) source.append("LD a\nAND( b\nORN c\n)\nST ").append(out).append("\n");
    if (rung % 3 == 0) source.append("LDN d\nAND ").append(in).append("\nS lamp\nLD b\nR lamp\n");
    if (rung % 5 == 0) source.append("LD ").append(in).append("\nXOR a\nSTN c\n");
  }
  return source.append("END_PROGRAM\n");
}

void boolean_rungs(benchmark::State& state) {
  const IlProgram program = compiled(rungs(static_cast<int>(state.range(0))));
  IlMachine machine{program};
  std::array<std::byte, 64> inputs{};
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] = static_cast<std::byte>(i * 37 + 11);
  std::array<std::byte, 64> outputs{};
  std::uint64_t instructions = 0;
  for (auto _ : state) {
    const auto scan = machine.run_scan({inputs, outputs, {}}, std::chrono::nanoseconds{0});
    if (!scan) return state.SkipWithError("fault");
    instructions += *scan;
  }
  state.counters["instructions"] = static_cast<double>(program.code.size());
  state.counters["instructions/s"] =
      benchmark::Counter(static_cast<double>(instructions), benchmark::Counter::kIsRate);
}
BENCHMARK(boolean_rungs)->Arg(10)->Arg(100)->Arg(1000)->Arg(5000);

/// A loop of integer arithmetic, comparison and a jump.
void integer_loop(benchmark::State& state) {
  const IlProgram program = compiled(
      "PROGRAM bench VAR i, sum : DINT; END_VAR\nLD 0\nST i\nagain: LD i\nADD 1\nST i\nMUL 3\nADD sum\nST "
      "sum\n"
      "LD i\nLT 1000\nJMPC again\nEND_PROGRAM\n");
  IlMachine machine{program};
  std::uint64_t instructions = 0;
  for (auto _ : state) {
    const auto scan = machine.run_scan({}, std::chrono::nanoseconds{0});
    if (!scan) return state.SkipWithError("fault");
    instructions += *scan;
  }
  state.counters["instructions/s"] =
      benchmark::Counter(static_cast<double>(instructions), benchmark::Counter::kIsRate);
}
BENCHMARK(integer_loop);

void compile_rungs(benchmark::State& state) {
  const std::string source = rungs(1000);
  for (auto _ : state) benchmark::DoNotOptimize(compile(source));
}
BENCHMARK(compile_rungs);

}  // namespace

BENCHMARK_MAIN();
