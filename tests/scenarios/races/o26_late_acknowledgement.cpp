// A serial line keeps what was sent. After one time-out each answer that is read belongs to the request before it
// (rayforge #217, libmodbus #255).

#include <array>
#include <optional>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr std::uint32_t requests_count = 2;

/// One direction of the line: bytes in their order.
struct Wire {
  std::array<std::atomic<std::uint32_t>, 4> bytes;
};

class Line {
 public:
  explicit Line(const char* name) : wire_(name), written_(name) {}

  void send(std::uint32_t byte) {
    wire_->bytes[next_++] = byte;
    written_.ring();
  }
  std::uint32_t receive() {
    written_.wait();
    return wire_->bytes[next_++];
  }
  std::optional<std::uint32_t> receive_within(races::Milliseconds timeout) {
    if (!written_.wait_for(timeout)) return std::nullopt;
    return wire_->bytes[next_++];
  }

 private:
  races::Shared<Wire> wire_;
  races::Doorbell written_;
  std::size_t next_ = 0;
};

}  // namespace

SHAPE(
    "races/o26-late-acknowledgement",
    {.finding = "I1", .depth = 1, .tasks_count = 2, .cure = "answers are numbered, and others' are dropped"},
    "on a serial line each answer is one behind after a time-out") {
  races::name_words(world, "to-slave", {"byte-0", "byte-1"});
  races::name_words(world, "to-master", {"byte-0", "byte-1"});

  world.process("master").start("main", [&] {
    Line to_slave{"to-slave"};
    Line to_master{"to-master"};
    for (std::uint32_t number = 1; number <= requests_count; ++number) {
      to_slave.send(number);
      auto answer = to_master.receive_within(races::Milliseconds{10});
      while (corrected && answer && *answer != number)
        answer = to_master.receive_within(races::Milliseconds{10});
      world.require(!answer || *answer == number, "I1: the answer to an older request was delivered");
    }
  });
  world.process("slave").start("main", [] {
    Line to_slave{"to-slave"};
    Line to_master{"to-master"};
    for (std::uint32_t served = 0; served < requests_count; ++served) to_master.send(to_slave.receive());
  });
  world.run();
}
