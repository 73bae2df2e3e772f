// What a function has of its caller, where it was called: the registers that must be the same when it returns, and the stack.
//
// For who looks at a task that stands still in the simulator: the frames of the simulator's own functions hold words that decide
// nothing, such as how many steps there were. What the caller has, lies above its call, or in these registers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace ltsim {

/// System V ABI for x86-64, 3.2.1: rbx, rbp, r12 to r15.
struct KeptRegisters {
  void* stack_pointer =
      nullptr;  ///< where the address lies to which the callee returns; null: nobody has called
  std::array<std::uint64_t, 6> others{};
};
static_assert(sizeof(KeptRegisters) == 56 && offsetof(KeptRegisters, others) == 8);

/// Calls the function, and before that keeps the registers of who called this one.
extern "C" std::uint64_t ltsim_keep_registers_and_call(KeptRegisters* kept, std::uint64_t (*function)(void*),
                                                       void* argument) noexcept;

}  // namespace ltsim
