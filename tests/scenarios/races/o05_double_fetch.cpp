// The length in the peer's memory is checked, and read again for the copy (CVE-2015-8550 / XSA-155, wolfHSM PR #410).

#include <array>
#include <cstddef>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr std::uint32_t capacity_bytes = 8;

struct Message {
  std::atomic<std::uint32_t> length_bytes;
  std::array<std::atomic<std::uint8_t>, 16> bytes;
};

}  // namespace

SHAPE("races/o05-double-fetch",
      {.finding = "I8",
       .depth = 2,
       .tasks_count = 2,
       .cure = "one load into a local, which is checked and used"},
      "a length is checked and then read again") {
  races::name_words(world, "message", {"length"});
  world.name_region("message", offsetof(Message, bytes), sizeof(Message::bytes), "message.bytes");

  world.process("guest").start("main", [&] {
    const races::Shared<Message> message{"message"};
    races::Doorbell doorbell{"doorbell"};
    message->length_bytes = 4;
    doorbell.ring();
    message->length_bytes = 12;  // already the next message, without waiting
  });
  world.process("host").start("main", [&] {
    const races::Shared<Message> message{"message"};
    races::Doorbell doorbell{"doorbell"};
    doorbell.wait();
    const std::uint32_t length_bytes = message->length_bytes;
    if (length_bytes > capacity_bytes) return;
    const std::uint32_t copied_bytes = corrected ? length_bytes : message->length_bytes.load();
    world.require(copied_bytes <= capacity_bytes, "I8: more bytes are copied than there is room for");
    std::array<std::uint8_t, capacity_bytes> copy{};
    for (std::uint32_t i = 0; i < copied_bytes; ++i) copy[i] = message->bytes[i];
  });
  world.run();
}
