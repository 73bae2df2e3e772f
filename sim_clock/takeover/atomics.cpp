// Atomic operations, which instrumented code calls instead of performing them. In a simulated task each is a
// scheduling point, wherever its memory lies: what is atomic is meant for other tasks. Only one task runs at
// a time, so the operation itself needs no ordering; memory is sequentially consistent.
//
// Names and signatures: see memory_accesses.cpp. The `int` is the memory order: it says what the operation
// orders, for the race detector.

#include <cstdint>

#include "sim_clock/check/code_site.hpp"
#include "sim_clock/takeover/shared_access.hpp"
#include "sim_clock/world/world.hpp"

namespace {

using ltsim::AtomicAccess;
using ltsim::OperationKind;
using ltsim::Segments;

/// @param caller  return address of the operation: it stands in the code under test
/// @return        whether a simulated task is about to perform the operation
bool point(const volatile void* address, std::size_t bytes, OperationKind kind, const void* caller) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr) return false;
  if (Segments::contains(address)) {
    ltsim::access_shared(*self->world, address, bytes, kind, ltsim::code_site(caller));
  } else {
    self->world->scheduler().point(
        {.kind = kind,
         .bytes = static_cast<std::uint8_t>(bytes),
         .offset = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address)),
         .site = ltsim::code_site(caller)});
  }
  return true;
}

/// The operation was performed, as what it turned out to be: a compare-and-exchange that fails is a load.
void performed(const volatile void* address, std::size_t bytes, AtomicAccess access, int order,
               const void* caller) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr || !self->world->checks().on()) return;
  self->world->checks().atomic({.task = self->id,
                                .place = Segments::place_of(address),
                                .bytes = static_cast<std::uint8_t>(bytes),
                                .writes = writes(access),
                                .plain = false,
                                .site = ltsim::code_site(caller)},
                               Segments::canonical(address), Segments::contains(address), access, order);
}

/// A task whose exchange fails again and again waits for others.
int exchanged(const volatile void* address, std::size_t bytes, bool success, int order, int failure_order,
              const void* caller) noexcept {
  if (ltsim::current_task != nullptr) ltsim::current_task->update_failed = !success;
  performed(address, bytes, success ? AtomicAccess::update : AtomicAccess::load,
            success ? order : failure_order, caller);
  return success ? 1 : 0;
}

void fence(int order) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self != nullptr) self->world->checks().fence(self->id, order);
}

}  // namespace

// Outside a task (other threads of the tool) the operation must really be atomic and ordered. The builtins do
// that; the one that would cost a fence is spared a task, which is alone anyway.
#define LTSIM_ATOMIC_UPDATE(bits, type, name, builtin, kind)                              \
  extern "C" type __tsan_atomic##bits##_##name(volatile type* p, type value, int order) { \
    const void* const caller = __builtin_return_address(0);                               \
    point(p, sizeof(type), OperationKind::kind, caller);                                  \
    const type before = builtin(p, value, __ATOMIC_SEQ_CST);                              \
    performed(p, sizeof(type), AtomicAccess::update, order, caller);                      \
    return before;                                                                        \
  }

#define LTSIM_ATOMIC_COMPARE(bits, type, name)                                                               \
  extern "C" int __tsan_atomic##bits##_compare_exchange_##name(volatile type* p, type* expected,             \
                                                               type desired, int order, int failure_order) { \
    const void* const caller = __builtin_return_address(0);                                                  \
    point(p, sizeof(type), OperationKind::atomic_update, caller);                                            \
    const bool success =                                                                                     \
        __atomic_compare_exchange_n(p, expected, desired, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);        \
    return exchanged(p, sizeof(type), success, order, failure_order, caller);                                \
  }

#define LTSIM_ATOMICS(bits, type)                                                                           \
  extern "C" type __tsan_atomic##bits##_load(const volatile type* p, int order) {                           \
    const void* const caller = __builtin_return_address(0);                                                 \
    point(p, sizeof(type), OperationKind::atomic_load, caller);                                             \
    const type value = __atomic_load_n(p, __ATOMIC_SEQ_CST);                                                \
    performed(p, sizeof(type), AtomicAccess::load, order, caller);                                          \
    return value;                                                                                           \
  }                                                                                                         \
  extern "C" void __tsan_atomic##bits##_store(volatile type* p, type value, int order) {                    \
    const void* const caller = __builtin_return_address(0);                                                 \
    const bool alone = point(p, sizeof(type), OperationKind::atomic_store, caller);                         \
    if (alone) {                                                                                            \
      __atomic_store_n(p, value, __ATOMIC_RELAXED);                                                         \
    } else {                                                                                                \
      __atomic_store_n(p, value, __ATOMIC_SEQ_CST);                                                         \
    }                                                                                                       \
    performed(p, sizeof(type), AtomicAccess::store, order, caller);                                         \
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
                                                             int order, int failure_order) {                \
    const void* const caller = __builtin_return_address(0);                                                 \
    point(p, sizeof(type), OperationKind::atomic_update, caller);                                           \
    const bool success =                                                                                    \
        __atomic_compare_exchange_n(p, &expected, desired, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);      \
    exchanged(p, sizeof(type), success, order, failure_order, caller);                                      \
    return expected;                                                                                        \
  }

LTSIM_ATOMICS(8, std::uint8_t)
LTSIM_ATOMICS(16, std::uint16_t)
LTSIM_ATOMICS(32, std::uint32_t)
LTSIM_ATOMICS(64, std::uint64_t)

// Fences change nothing here: memory is sequentially consistent. But races are judged by what the code says.
extern "C" void __tsan_atomic_thread_fence(int order) { fence(order); }
extern "C" void __tsan_atomic_signal_fence(int /*order*/) {}
