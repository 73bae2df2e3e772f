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
// Of engine_mutator.cpp, in the programs whose target has a mutator.
[[gnu::weak]] std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                                  unsigned seed);
// Of AddressSanitizer, which asks the program for options.
const char* __asan_default_options();
}

namespace {

const ltsim::FuzzTarget& target() {
  static const ltsim::FuzzTarget& only = ltsim::fuzz_targets().front();
  return only;
}

}  // namespace

// What was freed is kept from use for a while: some thousand runs are long enough, and the default of 256 MB is so long that
// each run works on pages that are new to it.
const char* __asan_default_options() { return "quarantine_size_mb=16"; }

int LLVMFuzzerInitialize(int* argc, char*** argv) {
  const bool has_mutator = target().format.mutate != nullptr;
  if (has_mutator != (&LLVMFuzzerCustomMutator != nullptr)) {
    std::fprintf(stderr, "fuzz-%.*s: say MUTATOR in fuzz/CMakeLists.txt if and only if the target has one\n",
                 static_cast<int>(target().name.size()), target().name.data());
    std::exit(2);
  }
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
