// The kernel's side of the handoff against a peer who writes what he likes into the segment, between any two accesses, and
// never answers otherwise.
//
// Only bounds are looked at: no access outside of the segment (the world sees to that), no more bytes to the kernel than may
// come there, none behind those that were delivered, the length loaded once, and an end of each call.

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include "fuzz/hostile_peer.hpp"
#include "protocol/shared_memory_port.hpp"
#include "sim_clock/scenario/fuzz_scenario.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;

PaperOptions choose_options(ltsim::World& world) {
  const fuzz::Switches chosen{world.choose("options", 128)};
  PaperOptions options = fuzz::small_areas();
  if (chosen[0]) options.read_wait = PaperOptions::ReadWait::immediately;
  if (chosen[1]) options.state_coding = PaperOptions::StateCoding::halves;
  if (chosen[2]) options.semaphore_maximum = PaperOptions::SemaphoreMaximum::one;
  if (chosen[3]) options.area_order = PaperOptions::AreaOrder::bytes_first;
  if (chosen[4]) options.state_taken_back = PaperOptions::StateTakenBack::by_nobody;
  if (chosen[5]) options.on_time_out = PaperOptions::OnTimeOut::send_again;
  if (chosen[6]) options.length_check = PaperOptions::LengthCheck::load_once;
  options.read_timeout = 5ms;
  return options;
}

/// Looks at how much the kernel is given.
class MeasuringObserver final : public protocol::ExchangeObserver {
 public:
  MeasuringObserver(ltsim::World& world, const protocol::SegmentLayout& layout)
      : world_{world}, response_bytes_max_{layout.response.capacity_bytes} {}
  void delivered(std::span<const std::byte> response) noexcept override {
    world_.require(response.size() <= response_bytes_max_,
                   "no more bytes are delivered than a response may have");
  }

 private:
  ltsim::World& world_;
  std::size_t response_bytes_max_;
};

/// Writes one request and reads what is called its answer.
void exchange_once(ltsim::World& world, protocol::SharedMemoryPort& port) {
  constexpr std::size_t longest = 10;  // there is room for 8
  constexpr std::byte guard{0xa5};
  constexpr std::array<std::byte, longest> request{};
  const auto sent = std::span{request}.first(world.choose("request", longest + 1));
  const auto written = port.write(sent);
  world.require(!written || *written == sent.size(), "a request is written whole or not at all");
  std::array<std::byte, 16> buffer;
  buffer.fill(guard);
  const auto into = std::span{buffer}.first(world.choose("room", buffer.size()));
  const auto read = port.read(into);
  const std::size_t count = read.value_or(0);
  world.require(count <= into.size(), "no more bytes are read than there is room for");
  world.require(std::ranges::all_of(std::span{buffer}.subspan(std::min(count, into.size())),
                                    [&](std::byte byte) { return byte == guard; }),
                "no byte is written behind those that are read");
}

}  // namespace

FUZZ_SCENARIO("hostile-master",
              "the kernel's side against a peer who rewrites the segment between any two accesses") {
  const PaperOptions options = choose_options(world);
  const protocol::SegmentLayout layout = protocol::segment_layout(options);
  const std::size_t requests = 1 + world.choose("requests", 3);
  fuzz::leave_to_hostile_peer(world, layout, static_cast<unsigned>(world.choose("tokens", 3)));
  world.single_fetch(fuzz::segment, static_cast<std::uint32_t>(layout.response.length_offset), 4,
                     "segment.response-length");
  world.process("kernel").start("main", [&] {
    MeasuringObserver observer{world, layout};
    protocol::SharedMemoryPort port{fuzz::segment, options, &observer};
    world.require(port.open().has_value(), "the segment can be opened");
    for (std::size_t i = 0; i < requests; ++i) {
      exchange_once(world, port);
      // What is loaded from here on is of another exchange, also where nothing was sent or waited for.
      std::this_thread::sleep_for(1ms);
    }
  });
  world.run();
}
