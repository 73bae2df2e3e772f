#include "tests/emulator_models/soft_plc/counted_allocations.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local std::uint64_t heap_calls = 0;

}  // namespace

void* operator new(std::size_t bytes) {
  ++heap_calls;
  if (void* const memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc{};
}

void operator delete(void* memory) noexcept {
  ++heap_calls;
  std::free(memory);
}

void operator delete(void* memory, std::size_t /*bytes*/) noexcept {
  ++heap_calls;
  std::free(memory);
}

namespace emulator_models::soft_plc {

std::uint64_t heap_calls_count() noexcept { return heap_calls; }

}  // namespace emulator_models::soft_plc
