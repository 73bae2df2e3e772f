// One slot between two processes, and a flag that says whose it is: the sender fills the slot and says full, the receiver
// copies the letter, wipes it and says empty. One shape for each memory order without which a letter arrives that nobody
// has sent (iceoryx #2006; PostgreSQL 4c853646, where "you may go on" was seen before a field was cleared).

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr std::uint32_t letters_count = 2;

enum Flag : std::uint32_t { empty, full };

struct Mailbox {
  std::atomic<std::uint32_t> flag, letter, copy;
};

/// The way back needs its orders because the receiver wipes: unordered, the wiping of one letter may come after the next
/// one in modification order. Of a receiver that only loads they are needed against load buffering alone, weak_ring.cpp.
struct MailboxOrders {
  std::memory_order full_store = std::memory_order_release;  // who sees it sees the letter
  std::memory_order full_load = std::memory_order_acquire;   // the letter is the one that is announced
  std::memory_order empty_store =
      std::memory_order_release;  // whoever fills the slot after it does so after the wiping
  std::memory_order empty_load = std::memory_order_acquire;  // the slot is filled after it was wiped
};

template <MailboxOrders orders>
void send(Mailbox& mailbox) {
  for (std::uint32_t number = 1; number <= letters_count; ++number) {
    const auto is_empty = [&] { return mailbox.flag.load(orders.empty_load) == empty; };
    if (!races::poll_until(is_empty)) return;
    mailbox.letter.store(number, std::memory_order_relaxed);  // both are published by the flag
    mailbox.copy.store(number, std::memory_order_relaxed);
    mailbox.flag.store(full, orders.full_store);
  }
}

template <MailboxOrders orders>
void receive(Mailbox& mailbox, ltsim::World& world) {
  for (std::uint32_t number = 1; number <= letters_count; ++number) {
    const auto is_full = [&] { return mailbox.flag.load(orders.full_load) == full; };
    if (!races::poll_until(is_full)) return;
    const std::uint32_t letter = mailbox.letter.load(std::memory_order_relaxed);
    const std::uint32_t copy = mailbox.copy.load(std::memory_order_relaxed);
    world.require(letter == number && copy == number, "I3: a letter is not the one that was sent");
    mailbox.letter.store(0, std::memory_order_relaxed);  // before the next letter, by the flag
    mailbox.copy.store(0, std::memory_order_relaxed);
    mailbox.flag.store(empty, orders.empty_store);
  }
}

template <MailboxOrders orders>
void run_mailbox(ltsim::World& world) {
  races::name_words(world, "mailbox", {"flag", "letter", "copy"});
  world.process("kernel").start("sender", [] { send<orders>(*races::Shared<Mailbox>{"mailbox"}); });
  world.process("emulator").start("receiver", [&world] {
    receive<orders>(*races::Shared<Mailbox>{"mailbox"}, world);
  });
  world.run();
}

constexpr MailboxOrders right;

}  // namespace

SHAPE("races/weak-mailbox-full-store",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the sender says full with release"},
      "a mailbox whose sender says full with a relaxed store (memory c11)") {
  corrected ? run_mailbox<right>(world) : run_mailbox<{.full_store = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-mailbox-full-load",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the receiver looks for full with acquire"},
      "a mailbox whose receiver looks for full with a relaxed load (memory c11)") {
  corrected ? run_mailbox<right>(world) : run_mailbox<{.full_load = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-mailbox-empty-store",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the receiver says empty with release"},
      "a mailbox whose receiver wipes and says empty with a relaxed store (memory c11)") {
  corrected ? run_mailbox<right>(world) : run_mailbox<{.empty_store = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-mailbox-empty-load",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the sender looks for empty with acquire"},
      "a mailbox whose sender looks for empty with a relaxed load and fills it (memory c11)") {
  corrected ? run_mailbox<right>(world) : run_mailbox<{.empty_load = std::memory_order_relaxed}>(world);
}
