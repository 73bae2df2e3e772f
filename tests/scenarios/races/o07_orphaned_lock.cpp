// A process is killed inside the critical section, and everybody else waits for the lock for ever (boostorg
// interprocess #65, #56; iceoryx #325).

#include <pthread.h>

#include <cerrno>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

/// What is written twice is equal, except while the lock is held.
struct Table {
  std::atomic<std::uint32_t> value, copy_of_value;
  alignas(16) pthread_mutex_t lock;
};

void make_lock(pthread_mutex_t& lock, bool robust) {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, robust ? PTHREAD_MUTEX_ROBUST : PTHREAD_MUTEX_STALLED);
  pthread_mutex_init(&lock, &attributes);
}

/// Takes the lock; from a dead owner, after repairing what it may have left half done.
void lock_and_repair(Table& table) {
  if (pthread_mutex_lock(&table.lock) != EOWNERDEAD) return;
  table.copy_of_value = table.value.load();
  pthread_mutex_consistent(&table.lock);
}

}  // namespace

SHAPE("races/o07-orphaned-lock",
      {.finding = "I17",
       .depth = 2,
       .tasks_count = 2,
       .cure = "a robust lock: who gets it next is told, and repairs"},
      "a process is killed while it holds a lock") {
  races::name_words(world, "table", {"value", "copy"});
  world.process("emulator").may_crash({.times = 1});

  world.process("kernel").start("main", [&] {
    const races::Shared<Table> table{"table"};
    races::Doorbell ready{"ready"};
    make_lock(table->lock, corrected);
    ready.ring();
    for (int reads = 0; reads < 2; ++reads) {
      lock_and_repair(*table);
      const std::uint32_t value = table->value;
      world.require(value == table->copy_of_value, "I3: a value is half written");
      pthread_mutex_unlock(&table->lock);
    }
  });
  world.process("emulator").start("main", [] {
    const races::Shared<Table> table{"table"};
    races::Doorbell ready{"ready"};
    ready.wait();
    for (std::uint32_t value = 1; value <= 2; ++value) {
      lock_and_repair(*table);
      table->value = value;
      table->copy_of_value = value;
      pthread_mutex_unlock(&table->lock);
    }
  });
  world.whenever_idle([&] {
    world.require(
        world.process("emulator").is_running() || !world.blocked_in("kernel/main").starts_with("mutex_lock"),
        "I17: the owner of a lock is dead, and the kernel waits for it");
  });
  world.run();
}
