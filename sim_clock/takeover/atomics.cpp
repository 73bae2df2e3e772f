// Atomic operations, which instrumented code calls instead of performing them. In a simulated task each is a
// scheduling point, wherever its memory lies: what is atomic is meant for other tasks. Only one task runs at
// a time, so the operation itself needs no ordering; memory is sequentially consistent.
//
// Names and signatures: see memory_accesses.cpp. The `int` is the memory order.

#include <cstdint>

#include "sim_clock/world/world.hpp"

namespace {

using ltsim::OperationKind;
using ltsim::Segments;

/// @return whether a simulated task is about to perform the operation
bool point(const volatile void* address, std::size_t bytes, OperationKind kind) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr) return false;
  if (Segments::contains(address)) {
    self->world->segments().access(address, bytes, kind);
  } else {
    self->world->scheduler().point(
        {.kind = kind,
         .bytes = static_cast<std::uint8_t>(bytes),
         .offset = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address))});
  }
  return true;
}

/// A task whose exchange fails again and again waits for others.
int updated(bool success) noexcept {
  if (ltsim::current_task != nullptr) ltsim::current_task->update_failed = !success;
  return success ? 1 : 0;
}

}  // namespace

// Outside a task (other threads of the tool) the operation must really be atomic and ordered. The builtins do
// that; the one that would cost a fence is spared a task, which is alone anyway.
#define LTSIM_ATOMIC_UPDATE(bits, type, name, builtin, kind)                                  \
  extern "C" type __tsan_atomic##bits##_##name(volatile type* p, type value, int /*order*/) { \
    point(p, sizeof(type), OperationKind::kind);                                              \
    return builtin(p, value, __ATOMIC_SEQ_CST);                                               \
  }

#define LTSIM_ATOMIC_COMPARE(bits, type, name)                                                         \
  extern "C" int __tsan_atomic##bits##_compare_exchange_##name(                                        \
      volatile type* p, type* expected, type desired, int /*order*/, int /*failure_order*/) {          \
    point(p, sizeof(type), OperationKind::atomic_update);                                              \
    return updated(                                                                                    \
        __atomic_compare_exchange_n(p, expected, desired, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST)); \
  }

#define LTSIM_ATOMICS(bits, type)                                                                           \
  extern "C" type __tsan_atomic##bits##_load(const volatile type* p, int /*order*/) {                       \
    point(p, sizeof(type), OperationKind::atomic_load);                                                     \
    return __atomic_load_n(p, __ATOMIC_SEQ_CST);                                                            \
  }                                                                                                         \
  extern "C" void __tsan_atomic##bits##_store(volatile type* p, type value, int /*order*/) {                \
    const bool alone = point(p, sizeof(type), OperationKind::atomic_store);                                 \
    if (alone) {                                                                                            \
      __atomic_store_n(p, value, __ATOMIC_RELAXED);                                                         \
    } else {                                                                                                \
      __atomic_store_n(p, value, __ATOMIC_SEQ_CST);                                                         \
    }                                                                                                       \
  }                                                                                                         \
  LTSIM_ATOMIC_UPDATE(bits, type, exchange, __atomic_exchange_n, atomic_exchange)                           \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_add, __atomic_fetch_add, atomic_update)                             \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_sub, __atomic_fetch_sub, atomic_update)                             \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_and, __atomic_fetch_and, atomic_update)                             \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_or, __atomic_fetch_or, atomic_update)                               \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_xor, __atomic_fetch_xor, atomic_update)                             \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_nand, __atomic_fetch_nand, atomic_update)                           \
  LTSIM_ATOMIC_COMPARE(bits, type, strong)                                                                  \
  LTSIM_ATOMIC_COMPARE(bits, type, weak)                                                                    \
  extern "C" type __tsan_atomic##bits##_compare_exchange_val(volatile type* p, type expected, type desired, \
                                                             int /*order*/, int /*failure_order*/) {        \
    point(p, sizeof(type), OperationKind::atomic_update);                                                   \
    updated(__atomic_compare_exchange_n(p, &expected, desired, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST)); \
    return expected;                                                                                        \
  }

LTSIM_ATOMICS(8, std::uint8_t)
LTSIM_ATOMICS(16, std::uint16_t)
LTSIM_ATOMICS(32, std::uint32_t)
LTSIM_ATOMICS(64, std::uint64_t)

// Fences order nothing here that is not ordered already.
extern "C" void __tsan_atomic_thread_fence(int /*order*/) {}
extern "C" void __tsan_atomic_signal_fence(int /*order*/) {}
