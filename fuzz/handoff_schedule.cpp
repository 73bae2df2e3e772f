// The whole published handoff, kernel and emulator, where it is sound: whatever is asked, however long, whoever is slow and
// interrupted, on whichever clock: nothing is found. What the envelope leaves open besides is chosen, too.
//
// The same program steers the scenarios of the hazards, which are outside of the envelope (--scenario=paper/h03-stale-answer).

#include <array>
#include <chrono>

#include "protocol/paper_options.hpp"
#include "sim_clock/scenario/fuzz_scenario.hpp"
#include "tests/scenarios/paper_exchange.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;

template <typename Value, std::size_t count>
Value chosen(ltsim::World& world, std::string_view what, const std::array<Value, count>& values) {
  return values[world.choose(what, count)];
}

/// What the design leaves open and is sound either way as long as nothing times out and nobody dies.
PaperOptions choose_options(ltsim::World& world) {
  PaperOptions options;
  options.state_coding =
      chosen(world, "state-coding",
             std::array{PaperOptions::StateCoding::enumeration, PaperOptions::StateCoding::halves});
  options.semaphore_maximum =
      chosen(world, "semaphore-maximum",
             std::array{PaperOptions::SemaphoreMaximum::large, PaperOptions::SemaphoreMaximum::one});
  options.area_order =
      chosen(world, "area-order",
             std::array{PaperOptions::AreaOrder::length_first, PaperOptions::AreaOrder::bytes_first});
  options.length_check =
      chosen(world, "length-check",
             std::array{PaperOptions::LengthCheck::none, PaperOptions::LengthCheck::check_and_load_again,
                        PaperOptions::LengthCheck::load_once});
  options.poll_interval = 10ms;  // a stall of seconds is a thousand looks, and a millisecond of ours
  return options;
}

}  // namespace

FUZZ_SCENARIO("handoff-schedule",
              "requests, faults, choices and time through the handoff where it is sound") {
  constexpr unsigned requests_max = 7;
  constexpr unsigned faults_max = 8;
  world.set_points_max(100'000);
  scenarios::PaperExchange exchange;
  exchange.options = choose_options(world);
  exchange.requests = 1 + static_cast<unsigned>(world.choose("requests", requests_max));
  exchange.lengths_are_asked = true;
  exchange.emulator_is_late = world.choose("late", 2) != 0;
  world.grant(ltsim::FaultKind::interrupt, faults_max);
  world.grant(ltsim::FaultKind::clock_step, faults_max);
  world.process("kernel").may_stall(2);
  world.process("emulator").may_stall(2);
  scenarios::run_exchange(world, exchange);
}
