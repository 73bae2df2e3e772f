// A ring of two slots between two processes, one of which produces and the other consumes: each side counts on in a
// word of its own and looks at the other's. One shape for each memory order without which an element arrives that is not
// the next one, or a slot is filled while it is read (kvmtool 15c4e1ef906e, FreeBSD D46152, iceoryx #2006).

#include <array>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr std::uint32_t slots_count = 2;
constexpr std::uint32_t elements_count = 4;  // each slot is used again

/// @tparam Slot  an atomic shows which wrong element arrives; a plain integer, that it is filled and read at the same time
template <class Slot>
struct Ring {
  std::atomic<std::uint32_t> taken, given;  // how many so far: head and tail
  std::array<Slot, slots_count> slots;
};

using AtomicSlot = std::atomic<std::uint32_t>;
using PlainSlot = std::uint32_t;

std::uint32_t load(const AtomicSlot& slot) { return slot.load(std::memory_order_relaxed); }
std::uint32_t load(const PlainSlot& slot) { return slot; }
void store(AtomicSlot& slot, std::uint32_t element) { slot.store(element, std::memory_order_relaxed); }
void store(PlainSlot& slot, std::uint32_t element) { slot = element; }

/// The orders of `taken` are shown with plain slots, as rings have them: without one of the two a slot is filled while it
/// is read, by the rules of the language. That is a data race, which is found whatever the memory is.
///
/// With atomic slots they are needed against load buffering alone. What the consumer loads from a slot is the element
/// announced or a later one: the announced one happens before the load, by `given`, and all stores to the slot are the
/// producer's, in his order. A later one he stores only after a load of `taken` has told him that this very load is done.
/// So without either order the load could see a store that is made because of it. C++20 allows such a circle of relaxed
/// accesses, and ARM does where the store of `taken` is relaxed; here no load sees a store that is carried out after it
/// (WeakMemory). Where the consumer stores to the slots, too, the way back is needed for more: weak_mailbox.cpp.
struct RingOrders {
  std::memory_order given_store = std::memory_order_release;  // who sees it sees the slot filled
  std::memory_order given_load = std::memory_order_acquire;   // the slot is loaded as filled as `given` says
  std::memory_order taken_store = std::memory_order_release;  // who sees it fills the slot after its reading
  std::memory_order taken_load = std::memory_order_acquire;   // the slot is filled after what `taken` says
};

template <RingOrders orders, class Slot>
void produce(Ring<Slot>& ring) {
  for (std::uint32_t given = 0; given < elements_count; ++given) {
    const auto has_room = [&] { return given - ring.taken.load(orders.taken_load) < slots_count; };
    if (!races::poll_until(has_room)) return;
    store(ring.slots[given % slots_count], given + 1);  // published by `given`
    ring.given.store(given + 1, orders.given_store);
  }
}

template <RingOrders orders, class Slot>
void consume(Ring<Slot>& ring, ltsim::World& world) {
  for (std::uint32_t taken = 0; taken < elements_count; ++taken) {
    const auto has_element = [&] { return ring.given.load(orders.given_load) != taken; };
    if (!races::poll_until(has_element)) return;
    const std::uint32_t element = load(ring.slots[taken % slots_count]);
    world.require(element == taken + 1, "I3: an element is not the one that was given in its turn");
    ring.taken.store(taken + 1, orders.taken_store);
  }
}

template <class Slot, RingOrders orders>
void run_ring(ltsim::World& world) {
  races::name_words(world, "ring", {"taken", "given", "slot-0", "slot-1"});
  world.process("kernel").start("producer", [] { produce<orders>(*races::Shared<Ring<Slot>>{"ring"}); });
  world.process("emulator").start("consumer", [&world] {
    consume<orders>(*races::Shared<Ring<Slot>>{"ring"}, world);
  });
  world.run();
}

constexpr RingOrders right;

}  // namespace

SHAPE("races/weak-ring-given-store",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the producer stores how many it has given with release"},
      "a ring whose producer counts on with a relaxed store (memory c11)") {
  corrected ? run_ring<AtomicSlot, right>(world)
            : run_ring<AtomicSlot, RingOrders{.given_store = std::memory_order_relaxed}>(world);
}

SHAPE("races/weak-ring-given-load",
      {.finding = "I3",
       .depth = 1,
       .tasks_count = 2,
       .memory = ltsim::Memory::c11,
       .cure = "the consumer loads how many were given with acquire"},
      "a ring whose consumer looks for elements with a relaxed load (memory c11)") {
  corrected ? run_ring<AtomicSlot, right>(world)
            : run_ring<AtomicSlot, RingOrders{.given_load = std::memory_order_relaxed}>(world);
}

SHAPE("races/ring-taken-store",
      {.finding = "data-race",
       .depth = 1,
       .tasks_count = 2,
       .cure = "the consumer stores how many it has taken with release"},
      "a ring whose consumer counts on with a relaxed store") {
  corrected ? run_ring<PlainSlot, right>(world)
            : run_ring<PlainSlot, RingOrders{.taken_store = std::memory_order_relaxed}>(world);
}

SHAPE("races/ring-taken-load",
      {.finding = "data-race",
       .depth = 1,
       .tasks_count = 2,
       .cure = "the producer loads how many were taken with acquire"},
      "a ring whose producer looks for room with a relaxed load") {
  corrected ? run_ring<PlainSlot, right>(world)
            : run_ring<PlainSlot, RingOrders{.taken_load = std::memory_order_relaxed}>(world);
}
