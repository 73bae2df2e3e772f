// The emulator's side of the hardened handoff against a peer who writes what he likes into the segment, and rings, between any
// two accesses.
//
// What is executed is a request that lay there whole: of the very bytes that the slave has read a second decoder says so. None
// is executed twice in a row; an answer is whole and tells what it answers; the length is loaded once; no access is outside of
// the segment (the world sees to that), and when nobody rings any more the slave waits, so that it can be stopped.

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "fuzz/hostile_hardened_peer.hpp"
#include "protocol/hardened/slave.hpp"
#include "sim_clock/scenario/fuzz_scenario.hpp"

namespace {

using namespace std::chrono_literals;
namespace hardened = protocol::hardened;
namespace reference = fuzz::reference;

/// Answers as many bytes as it is told to, also more than there is room for.
class ChoosingPlc final : public emulator_models::IPlcEmulator {
 public:
  explicit ChoosingPlc(ltsim::World& world) : world_{world} {}
  protocol::fx::FrameBytes process(std::span<const std::byte> /*request*/) noexcept override {
    constexpr std::size_t answers_count = 40;  // there is room for 24
    return protocol::fx::FrameBytes(world_.choose("answer", answers_count), std::byte{0x5A});
  }

 private:
  ltsim::World& world_;
};

class Judge final : public protocol::ExchangeObserver {
 public:
  Judge(ltsim::World& world, const protocol::SegmentLayout& layout) : world_{world}, layout_{layout} {}

  void taken() noexcept override { request_ = {}; }

  void executed(std::span<const std::byte> payload) noexcept override {
    world_.require(payload.size() + reference::header_bytes <= layout_.request.capacity_bytes,
                   "no more bytes reach the PLC than a request may have");
    world_.require(!reference::decode(reference::Kind::request, reference::message_around(payload), request_),
                   "what is executed was submitted whole");
    world_.require(!last_ || request_.session != last_->session || request_.sequence != last_->sequence,
                   "no request is executed twice in a row");
    is_executed_ = true;
    last_ = request_;
  }

  void answered(std::span<const std::byte> payload) noexcept override {
    reference::Message answer;
    world_.require(!reference::decode(reference::Kind::response, reference::message_around(payload), answer),
                   "an answer is whole");
    if (!std::exchange(is_executed_, false)) return;
    world_.require(answer.session == request_.session && answer.sequence == request_.sequence,
                   "an answer tells what it answers");
    world_.require(request_.slave == 0 || request_.slave == answer.slave,
                   "what is for another slave is not executed");
  }

 private:
  ltsim::World& world_;
  protocol::SegmentLayout layout_;
  reference::Message request_;
  std::optional<reference::Message> last_;  // that was executed
  bool is_executed_ = false;
};

}  // namespace

FUZZ_SCENARIO(
    "hostile-hardened-slave",
    "the emulator's side of the hardened handoff against a peer who rewrites the segment between any two "
    "accesses, and rings") {
  constexpr std::size_t deeds_max = 6;
  const hardened::Options options = fuzz::small_hardened_options();
  const protocol::SegmentLayout layout = fuzz::layout_of(options);
  fuzz::leave_to_foreign_writers(world, layout, {}, layout.request, "segment.request-length");
  const std::size_t deeds = 1 + world.choose("deeds", deeds_max);
  emulator_models::EmulatorHandler* serving = nullptr;
  world.process("emulator").start("main", [&] {
    ChoosingPlc plc{world};
    Judge judge{world, layout};
    hardened::Slave slave{fuzz::hardened_segment, options, &judge};
    emulator_models::EmulatorHandler handler{slave, plc};
    world.require(slave.open().has_value(), "the segment can be opened");
    serving = &handler;
    handler.run();
  });
  world.process("kernel").start("main", [&] {
    while (serving == nullptr) std::this_thread::sleep_for(1ms);
    fuzz::HostilePeer peer{world, layout, reference::Kind::request, ".request"};
    for (std::size_t i = 0; i < deeds; ++i) peer.act();
    serving->request_stop();
  });
  world.run();
}
