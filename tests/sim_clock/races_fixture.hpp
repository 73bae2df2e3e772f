// For tests of the checks of memory: two processes that share a segment, at addresses of their own.
#pragma once

#include <semaphore.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <initializer_list>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {

class RacesTest : public CallsTest {
 protected:
  struct Memory {
    int value;
    std::array<unsigned char, 28> bytes;
    std::atomic<int> flag;
    std::atomic<int> other_flag;
  };

  using Body = std::function<void(Memory&)>;

  // Accesses that the compiler can neither leave out nor join with others.
  [[gnu::noinline]] static void write(int& value) { value = 1; }
  [[gnu::noinline]] static void write(unsigned char& byte) { byte = 1; }
  [[gnu::noinline]] static void read(const int& value) { seen = value; }
  [[gnu::noinline]] static void read(const unsigned char& byte) { seen = byte; }

  /// Each body is the main task of a process of its own. They run to their ends, one after the other; whether
  /// anything orders them is another matter.
  static Outcome run_in_turn(std::initializer_list<Body> bodies) {
    return run([&bodies](World& world) {
      world.name_region("segment", offsetof(Memory, value), sizeof(int), "segment.value");
      world.name_region("segment", offsetof(Memory, bytes), sizeof(Memory::bytes), "segment.bytes");
      int number = 0;
      for (const Body& body : bodies) {
        world.process(std::string(1, static_cast<char>('a' + number++))).start("main", [&body] {
          body(*static_cast<Memory*>(map_segment()));
        });
      }
    });
  }

  /// One process, one task, which may create threads.
  static Outcome run_alone(const Body& body) { return run_in_turn({body}); }

  static inline volatile int seen = 0;
};

/// Tells whether two accesses race.
class RaceDetectorTest : public RacesTest {
 protected:
  static OutcomeKind kind_of(std::initializer_list<Body> bodies) { return run_in_turn(bodies).kind; }

  /// What comes of a write to the value, `hand_over`, and in another process `receive` and a read of it.
  static OutcomeKind message_passing(const Body& hand_over, const Body& receive) {
    return kind_of({[&](Memory& memory) {
                      write(memory.value);
                      hand_over(memory);
                    },
                    [&](Memory& memory) {
                      receive(memory);
                      read(memory.value);
                    }});
  }
};

inline constexpr OutcomeKind ordered = OutcomeKind::passed;
inline constexpr OutcomeKind race = OutcomeKind::data_race;

}  // namespace ltsim
