// The emulator's side of the handoff against a peer who writes what he likes into the segment, between any two accesses.
//
// Nothing that he writes says what is right, so only bounds are looked at: no access outside of the segment (the world sees
// to that), no more bytes to the PLC than may come there, the length loaded once, and an end.

#include <algorithm>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "fuzz/hostile_peer.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "sim_clock/scenario/fuzz_scenario.hpp"

namespace {

using protocol::PaperOptions;

PaperOptions choose_options(ltsim::World& world) {
  const fuzz::Switches chosen{world.choose("options", 16)};
  PaperOptions options = fuzz::small_areas();
  if (chosen[0]) options.state_coding = PaperOptions::StateCoding::halves;
  if (chosen[1]) options.semaphore_after_answer = PaperOptions::SemaphoreAfterAnswer::reset;
  if (chosen[2]) options.area_order = PaperOptions::AreaOrder::bytes_first;
  if (chosen[3]) options.length_check = PaperOptions::LengthCheck::load_once;
  return options;
}

/// Looks at how much it is given; answers as many bytes as it is told to, also more than there is room for.
class MeasuringPlc final : public emulator_models::IPlcEmulator {
 public:
  MeasuringPlc(ltsim::World& world, const PaperOptions& options, const protocol::SegmentLayout& layout)
      : world_{world},
        request_bytes_max_{options.length_check == PaperOptions::LengthCheck::none
                               ? layout.size_bytes - layout.request.bytes_offset
                               : layout.request.capacity_bytes} {}

  protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override {
    world_.require(request.size() <= request_bytes_max_,
                   "no more bytes reach the PLC than a request may have");
    constexpr std::size_t answers_count = 16;  // 0 to 15 bytes; there is room for 8
    return protocol::fx::FrameBytes(world_.choose("answer", answers_count), std::byte{0x5a});
  }

 private:
  ltsim::World& world_;
  std::size_t request_bytes_max_;
};

/// Has the slave stopped behind an answer.
class Stopper final : public protocol::ExchangeObserver {
 public:
  explicit Stopper(std::size_t answers_count) : left_{answers_count} {}
  void stops(emulator_models::EmulatorHandler& handler) { handler_ = &handler; }
  void announced() noexcept override {
    if (--left_ == 0) handler_->request_stop();
  }

 private:
  emulator_models::EmulatorHandler* handler_ = nullptr;
  std::size_t left_;
};

}  // namespace

FUZZ_SCENARIO("hostile-slave",
              "the emulator's side against a peer who rewrites the segment between any two accesses") {
  const PaperOptions options = choose_options(world);
  const protocol::SegmentLayout layout = protocol::segment_layout(options);
  const bool resets = options.semaphore_after_answer == PaperOptions::SemaphoreAfterAnswer::reset;
  const std::size_t tokens = 1 + world.choose("tokens", 4);
  fuzz::leave_to_hostile_peer(world, layout, static_cast<unsigned>(tokens));
  world.single_fetch(fuzz::segment, static_cast<std::uint32_t>(layout.request.length_offset), 4,
                     "segment.request-length");
  world.process("emulator").start("main", [&] {
    MeasuringPlc plc{world, options, layout};
    Stopper stopper{resets ? 1 : tokens};  // what is set to 0 wakes nobody
    protocol::SlaveSharedMemoryWrapper slave{fuzz::segment, options, &stopper};
    emulator_models::EmulatorHandler handler{slave, plc};
    stopper.stops(handler);
    world.require(slave.open().has_value(), "the segment can be opened");
    handler.run();
  });
  world.run();
}
