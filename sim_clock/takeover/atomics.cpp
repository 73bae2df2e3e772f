// Atomic operations, which instrumented code calls instead of performing them. In a simulated task each is a
// scheduling point, wherever its memory lies: what is atomic is meant for other tasks. Only one task runs at
// a time, so the operation itself needs no ordering; where memory is weak, WeakMemory carries it out.
//
// Names and signatures: see memory_accesses.cpp. The `int` is the memory order: it says what the operation
// orders, for the race detector and for a weak memory.

#include <cstdint>

#include <fmt/format.h>

#include "sim_clock/takeover/shared_access.hpp"
#include "sim_clock/world/world.hpp"

namespace {

using ltsim::AtomicAccess;
using ltsim::OperationKind;
using ltsim::Segments;
using ltsim::WeakMemory;

/// @param caller  return address of the operation: it stands in the code under test
/// @return        whether a simulated task is about to perform the operation
bool point(const volatile void* address, std::size_t bytes, OperationKind kind, int order,
           const void* caller) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr) return false;
  if (Segments::contains(address)) {
    ltsim::access_shared(*self->world, address, bytes, kind, ltsim::ProgramImage::site_of(caller),
                         ltsim::is_seq_cst(order));
  } else if (!ltsim::access_program(*self->world, address, bytes, kind, ltsim::ProgramImage::site_of(caller),
                                    ltsim::is_seq_cst(order))) {
    self->world->scheduler().point(
        {.kind = kind,
         .bytes = static_cast<std::uint8_t>(bytes),
         .is_seq_cst = ltsim::is_seq_cst(order),
         .offset = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address)),
         .site = ltsim::ProgramImage::site_of(caller)});
  }
  return true;
}

ltsim::SharedAccess shared_access(const ltsim::Task& self, ltsim::SharedPlace place, std::size_t bytes,
                                  AtomicAccess access, const void* caller) noexcept {
  return {.task = self.id,
          .place = place,
          .bytes = static_cast<std::uint8_t>(bytes),
          .writes = writes(access),
          .plain = false,
          .site = ltsim::ProgramImage::site_of(caller)};
}

/// The operation was performed, as what it turned out to be: a compare-and-exchange that fails is a load.
void performed(const volatile void* address, std::size_t bytes, AtomicAccess access, int order,
               const void* caller) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr || !self->world->checks().on()) return;
  const auto place = ltsim::shared_place(address);
  self->world->checks().atomic(shared_access(*self, place.value_or(0), bytes, access, caller),
                               Segments::canonical(address), place.has_value(), access, order);
}

/// Whether this is an operation of a simulated task whose memory is weak.
bool is_weak() noexcept {
  return ltsim::current_task != nullptr && ltsim::current_task->world->weak_memory().on();
}

WeakMemory::Result perform_weakly(const WeakMemory::Access& access, const void* caller) noexcept {
  ltsim::World& world = *ltsim::current_task->world;
  const WeakMemory::Result result = world.weak_memory().access(access);
  const AtomicAccess done =
      access.kind == AtomicAccess::update && !result.stored ? AtomicAccess::load : access.kind;
  const auto place = ltsim::shared_place(access.address);
  if (world.checks().on() && place) {
    ltsim::SharedAccess shared = shared_access(*ltsim::current_task, *place, access.bytes, done, caller);
    shared.ticks = result.ticks;
    world.checks().accessed(shared, reads(done));
  }
  return result;
}

/// A task whose exchange fails again and again waits for others.
void failed_if(bool failed) noexcept {
  ltsim::current_task->update_failed = failed;
  if (failed) ltsim::current_task->world->scheduler().only_looked();
}

int exchanged(const volatile void* address, std::size_t bytes, bool success, int order, int failure_order,
              const void* caller) noexcept {
  if (ltsim::current_task != nullptr) failed_if(!success);
  performed(address, bytes, success ? AtomicAccess::update : AtomicAccess::load,
            success ? order : failure_order, caller);
  return success ? 1 : 0;
}

void fence(int order) noexcept {
  ltsim::Task* const self = ltsim::current_task;
  if (self == nullptr) return;
  if (self->world->weak_memory().on()) {
    // What a seq_cst fence orders depends on those that come before it; any other is a matter of its task alone.
    if (ltsim::is_seq_cst(order))
      self->world->scheduler().point({.kind = OperationKind::atomic_fence, .is_seq_cst = true});
    self->world->weak_memory().fence(self->id, order);
  } else {
    self->world->checks().fence(self->id, order);
  }
}

// What an update makes of what it found.
std::uint64_t exchanges(std::uint64_t /*found*/, std::uint64_t operand) { return operand; }
std::uint64_t adds(std::uint64_t found, std::uint64_t operand) { return found + operand; }
std::uint64_t subtracts(std::uint64_t found, std::uint64_t operand) { return found - operand; }
std::uint64_t ands(std::uint64_t found, std::uint64_t operand) { return found & operand; }
std::uint64_t ors(std::uint64_t found, std::uint64_t operand) { return found | operand; }
std::uint64_t xors(std::uint64_t found, std::uint64_t operand) { return found ^ operand; }
std::uint64_t nands(std::uint64_t found, std::uint64_t operand) { return ~(found & operand); }

/// @param expected  gets what was found, if that is something else
template <typename Type>
int compare_exchange(volatile Type* p, Type* expected, Type desired, int order, int failure_order,
                     const void* caller) noexcept {
  point(p, sizeof(Type), OperationKind::atomic_update, order, caller);
  if (is_weak()) [[unlikely]] {
    const auto result = perform_weakly({.address = p,
                                        .bytes = sizeof(Type),
                                        .kind = AtomicAccess::update,
                                        .order = order,
                                        .failure_order = failure_order,
                                        .expected = *expected,
                                        .operand = desired,
                                        .change = exchanges},
                                       caller);
    failed_if(!result.stored);
    if (!result.stored) *expected = static_cast<Type>(result.found);
    return result.stored ? 1 : 0;
  }
  const bool success =
      __atomic_compare_exchange_n(p, expected, desired, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
  return exchanged(p, sizeof(Type), success, order, failure_order, caller);
}

}  // namespace

// Outside a task (other threads of the tool) the operation must really be atomic and ordered. The builtins do
// that; the one that would cost a fence is spared a task, which is alone anyway.
#define LTSIM_ATOMIC_UPDATE(bits, type, name, builtin, kind_of_point, makes)              \
  extern "C" type __tsan_atomic##bits##_##name(volatile type* p, type value, int order) { \
    const void* const caller = __builtin_return_address(0);                               \
    point(p, sizeof(type), OperationKind::kind_of_point, order, caller);                  \
    if (is_weak()) [[unlikely]]                                                           \
      return static_cast<type>(perform_weakly({.address = p,                              \
                                               .bytes = sizeof(type),                     \
                                               .kind = AtomicAccess::update,              \
                                               .order = order,                            \
                                               .expected = std::nullopt,                  \
                                               .operand = value,                          \
                                               .change = makes},                          \
                                              caller)                                     \
                                   .found);                                               \
    const type before = builtin(p, value, __ATOMIC_SEQ_CST);                              \
    performed(p, sizeof(type), AtomicAccess::update, order, caller);                      \
    return before;                                                                        \
  }

#define LTSIM_ATOMIC_COMPARE(bits, type, name)                                                               \
  extern "C" int __tsan_atomic##bits##_compare_exchange_##name(volatile type* p, type* expected,             \
                                                               type desired, int order, int failure_order) { \
    return compare_exchange(p, expected, desired, order, failure_order, __builtin_return_address(0));        \
  }

#define LTSIM_ATOMICS(bits, type)                                                                           \
  extern "C" type __tsan_atomic##bits##_load(const volatile type* p, int order) {                           \
    const void* const caller = __builtin_return_address(0);                                                 \
    point(p, sizeof(type), OperationKind::atomic_load, order, caller);                                      \
    if (is_weak()) [[unlikely]]                                                                             \
      return static_cast<type>(perform_weakly({.address = p,                                                \
                                               .bytes = sizeof(type),                                       \
                                               .kind = AtomicAccess::load,                                  \
                                               .order = order,                                              \
                                               .expected = std::nullopt},                                   \
                                              caller)                                                       \
                                   .found);                                                                 \
    const type value = __atomic_load_n(p, __ATOMIC_SEQ_CST);                                                \
    performed(p, sizeof(type), AtomicAccess::load, order, caller);                                          \
    return value;                                                                                           \
  }                                                                                                         \
  extern "C" void __tsan_atomic##bits##_store(volatile type* p, type value, int order) {                    \
    const void* const caller = __builtin_return_address(0);                                                 \
    const bool alone = point(p, sizeof(type), OperationKind::atomic_store, order, caller);                  \
    if (is_weak()) [[unlikely]] {                                                                           \
      perform_weakly({.address = p,                                                                         \
                      .bytes = sizeof(type),                                                                \
                      .kind = AtomicAccess::store,                                                          \
                      .order = order,                                                                       \
                      .expected = std::nullopt,                                                             \
                      .operand = value},                                                                    \
                     caller);                                                                               \
      return;                                                                                               \
    }                                                                                                       \
    if (alone) {                                                                                            \
      __atomic_store_n(p, value, __ATOMIC_RELAXED);                                                         \
    } else {                                                                                                \
      __atomic_store_n(p, value, __ATOMIC_SEQ_CST);                                                         \
    }                                                                                                       \
    performed(p, sizeof(type), AtomicAccess::store, order, caller);                                         \
  }                                                                                                         \
  LTSIM_ATOMIC_UPDATE(bits, type, exchange, __atomic_exchange_n, atomic_exchange, exchanges)                \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_add, __atomic_fetch_add, atomic_update, adds)                       \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_sub, __atomic_fetch_sub, atomic_update, subtracts)                  \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_and, __atomic_fetch_and, atomic_update, ands)                       \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_or, __atomic_fetch_or, atomic_update, ors)                          \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_xor, __atomic_fetch_xor, atomic_update, xors)                       \
  LTSIM_ATOMIC_UPDATE(bits, type, fetch_nand, __atomic_fetch_nand, atomic_update, nands)                    \
  LTSIM_ATOMIC_COMPARE(bits, type, strong)                                                                  \
  LTSIM_ATOMIC_COMPARE(bits, type, weak)                                                                    \
  extern "C" type __tsan_atomic##bits##_compare_exchange_val(volatile type* p, type expected, type desired, \
                                                             int order, int failure_order) {                \
    compare_exchange(p, &expected, desired, order, failure_order, __builtin_return_address(0));             \
    return expected;                                                                                        \
  }

LTSIM_ATOMICS(8, std::uint8_t)
LTSIM_ATOMICS(16, std::uint16_t)
LTSIM_ATOMICS(32, std::uint32_t)
LTSIM_ATOMICS(64, std::uint64_t)

// Where memory is sequentially consistent a fence is no scheduling point.
extern "C" void __tsan_atomic_thread_fence(int order) { fence(order); }
extern "C" void __tsan_atomic_signal_fence(int /*order*/) {}

namespace {

/// What the instruction of inline assembly works on that the running task performs next.
struct LockedInstruction {
  volatile void* address;
  std::size_t bytes;
} locked_instruction;

}  // namespace

/// Called by takeover/inline_assembly.cpp. A weak memory would have to carry out the instruction itself: that is not simulated.
extern "C" void ltsim_locked_instruction_follows(volatile void* address, std::size_t bytes,
                                                 const void* caller) {
  if (is_weak())
    ltsim::current_task->world->unsupported(
        fmt::format("{} performs an atomic operation by inline assembly, which ltsim simulates only where "
                    "memory is sequentially consistent",
                    ltsim::current_task->name));
  point(address, bytes, OperationKind::atomic_update, __ATOMIC_SEQ_CST, caller);
  locked_instruction = {.address = address, .bytes = bytes};
}

/// @param success  false: it was a compare-and-exchange that found another value
extern "C" void ltsim_locked_instruction_was_performed(bool success, const void* caller) {
  exchanged(locked_instruction.address, locked_instruction.bytes, success, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST,
            caller);
}
