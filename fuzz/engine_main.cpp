// What a fuzzing engine calls: libFuzzer's interface, which AFL++ and the fuzzing services speak as well. The program has one
// target.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>

#include "fuzz/engine_arguments.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

extern "C" {
int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                    unsigned seed);
std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1, const std::uint8_t* data2,
                                      std::size_t size2, std::uint8_t* out, std::size_t size_max,
                                      unsigned seed);
// Of the engine. Weak: one that never calls the mutator need not have it.
[[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t size_max);
}

namespace {

const ltsim::FuzzTarget& target() {
  static const ltsim::FuzzTarget& only = ltsim::fuzz_targets().front();
  return only;
}

std::size_t mutate_as_engine(std::span<std::byte> data, std::size_t size) {
  return LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(data.data()), size, data.size());
}

}  // namespace

int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const std::span arguments{*argv, static_cast<std::size_t>(*argc)};
  if (target().needs_world()) {
    fuzz::obey_scenario_arguments(target(), arguments);
  } else {
    fuzz::replace_schedules_by_inputs(arguments);
  }
  return 0;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    target().run({reinterpret_cast<const std::byte*>(data), size});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz-%.*s: %s\n", static_cast<int>(target().name.size()), target().name.data(),
                 error.what());
    std::abort();
  }
  return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                    unsigned seed) {
  const std::span bytes{reinterpret_cast<std::byte*>(data), size_max};
  if (target().format.mutate == nullptr) return mutate_as_engine(bytes, size);
  return target().format.mutate(bytes, size, seed, mutate_as_engine);
}

// The engine asks for it as often as for all other changes together, and tries something else when there is nothing.
std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1, const std::uint8_t* data2,
                                      std::size_t size2, std::uint8_t* out, std::size_t size_max,
                                      unsigned seed) {
  constexpr unsigned one_of = 4;
  if (target().format.splice == nullptr || seed % one_of != 0) return 0;
  return target().format.splice({reinterpret_cast<const std::byte*>(data1), size1},
                                {reinterpret_cast<const std::byte*>(data2), size2},
                                {reinterpret_cast<std::byte*>(out), size_max}, seed);
}
