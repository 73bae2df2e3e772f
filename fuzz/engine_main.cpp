// What a fuzzing engine calls: libFuzzer's interface, which AFL++ and the fuzzing services speak as well. The program has one
// target.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include "fuzz/schedule_input.hpp"
#include "sim_clock/scenario/fuzz_target.hpp"

extern "C" {
int LLVMFuzzerInitialize(int* argc, char*** argv);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
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

// A schedule on the command line stands for the input in it: the engine gets that in a file of its own.
int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const std::filesystem::path path = (*argv)[i];
    if (path.extension() != ".schedule") continue;
    std::ifstream file{path, std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{file}, {}};
    const auto input = fuzz::input_of(text);
    if (!input) continue;
    static std::string name;
    name = std::filesystem::temp_directory_path() / ("fuzz-input-" + std::to_string(getpid()));
    std::ofstream{name, std::ios::binary} << *input;
    (*argv)[i] = name.data();
    std::atexit([] { std::filesystem::remove(name); });
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
