// How a fuzzing engine changes the inputs of a target with a format of its own. Not linked to the others: the engine calls it for
// every change, and no longer begins with short inputs where there is one.

#include <cstdint>
#include <span>

#include "sim_clock/scenario/fuzz_target.hpp"

extern "C" {
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                    unsigned seed);
std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1, const std::uint8_t* data2,
                                      std::size_t size2, std::uint8_t* out, std::size_t size_max,
                                      unsigned seed);
// Of the engine. Weak: one that never calls the mutator need not have it.
[[gnu::weak]] std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t size_max);
}

namespace {

const ltsim::InputFormat& format() { return ltsim::fuzz_targets().front().format; }

std::size_t mutate_as_engine(std::span<std::byte> data, std::size_t size) {
  return LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(data.data()), size, data.size());
}

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                    unsigned seed) {
  return format().mutate({reinterpret_cast<std::byte*>(data), size_max}, size, seed, mutate_as_engine);
}

// The engine asks for it as often as for all other changes together, and tries something else when there is nothing.
std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1, const std::uint8_t* data2,
                                      std::size_t size2, std::uint8_t* out, std::size_t size_max,
                                      unsigned seed) {
  constexpr unsigned one_of = 4;
  if (format().splice == nullptr || seed % one_of != 0) return 0;
  return format().splice({reinterpret_cast<const std::byte*>(data1), size1},
                         {reinterpret_cast<const std::byte*>(data2), size2},
                         {reinterpret_cast<std::byte*>(out), size_max}, seed);
}
