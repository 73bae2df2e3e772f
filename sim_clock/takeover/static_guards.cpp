// __cxa_guard_*: Itanium C++ ABI, 3.3.3. What libstdc++ has is not instrumented.

#include <dlfcn.h>

#include <cstdint>

#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

// LTSIM_NEXT() keeps what it has found in a static variable, whose guard would be looked for here.
template <typename Function>
Function* find(const char* name, Function*& found) noexcept {
  if (found == nullptr) found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
  return found;
}

int (*next_acquire)(std::uint64_t*) = nullptr;
void (*next_release)(std::uint64_t*) = nullptr;
void (*next_abort)(std::uint64_t*) = nullptr;

}  // namespace

extern "C" int __cxa_guard_acquire(std::uint64_t* guard) {
  if (current_task != nullptr) return current_task->world->static_guards().acquire(guard) ? 1 : 0;
  return find("__cxa_guard_acquire", next_acquire)(guard);
}

extern "C" void __cxa_guard_release(std::uint64_t* guard) noexcept {
  if (current_task != nullptr) return current_task->world->static_guards().release(guard);
  return find("__cxa_guard_release", next_release)(guard);
}

extern "C" void __cxa_guard_abort(std::uint64_t* guard) noexcept {
  if (current_task != nullptr) return current_task->world->static_guards().give_up(guard);
  return find("__cxa_guard_abort", next_abort)(guard);
}
