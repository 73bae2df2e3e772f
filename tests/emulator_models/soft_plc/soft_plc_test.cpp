// Several cycles as one PLC: orders, faults, outputs through the gate, the watchdog beside a cycle that hangs.
#include "emulator_models/soft_plc/soft_plc.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <thread>

#include "emulator_models/soft_plc/plc_threads.hpp"
#include "tests/emulator_models/soft_plc/plc_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

Progress count_on_outputs(const CycleImage& image, const ScanStep& /*step*/) {
  set_word(image.outputs, word(image.outputs) + 1);
  return Progress::finished;
}

std::unique_ptr<SoftPlc> make(std::vector<PlcCycleSetup> cycles) {
  return SoftPlc::make(setup_of(std::move(cycles)), 0ns).value();
}

std::vector<PlcCycleSetup> one(PlcCycleSetup only) {
  std::vector<PlcCycleSetup> cycles;
  cycles.push_back(std::move(only));
  return cycles;
}
std::vector<PlcCycleSetup> two(PlcCycleSetup a, PlcCycleSetup b) {
  auto cycles = one(std::move(a));
  cycles.push_back(std::move(b));
  return cycles;
}

ScriptedBody::Run idle() {
  return [](const CycleImage&, const ScanStep&) { return Progress::finished; };
}

TEST(SoftPlc, outputs_appear_in_RUN_and_are_safe_after_STOP) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  nanoseconds now{0};
  run_until(*plc, now, 25ms);
  EXPECT_EQ(word(plc->gate().frame().outputs), 0U);
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  run_until(*plc, now, 55ms);
  EXPECT_EQ(word(plc->gate().frame().outputs), 3U);
  plc->order_stop();
  run_until(*plc, now, 75ms);
  EXPECT_EQ(word(plc->gate().frame().outputs), 0U);
  EXPECT_TRUE(plc->is_stopped());
}

// I1
TEST(SoftPlc, the_first_cycle_that_carries_out_STOP_makes_the_outputs_of_all_safe) {
  const auto plc = make(two(cycle("fast", 1ms, {}, 0, count_on_outputs),
                            cycle("slow", 100ms, {}, 8, [](const CycleImage& image, const ScanStep&) {
                              set_word(image.outputs, 7, 8);
                              return Progress::finished;
                            })));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 10ms);
  EXPECT_EQ(word(plc->gate().frame().outputs, 8), 7U);
  plc->order_stop();
  run_until(*plc, now, 13ms);
  EXPECT_EQ(plc->status(1).mode, RunMode::run) << "the slow cycle has not begun a scan since";
  EXPECT_EQ(plc->gate().frame().outputs, OutputGate::Outputs{});
}

// I3
TEST(SoftPlc, a_run_time_fault_in_one_cycle_stops_all_and_lights_the_lamp) {
  bool fails = false;
  const auto plc = make(two(cycle("good", 5ms, {}, 0, count_on_outputs),
                            cycle("bad", 10ms, {}, 8, [&](const CycleImage&, const ScanStep&) {
                              return fails ? Progress::failed : Progress::finished;
                            })));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 31ms);
  EXPECT_FALSE(plc->alarm_lamp());
  fails = true;
  run_until(*plc, now, 61ms);
  EXPECT_TRUE(plc->alarm_lamp());
  EXPECT_EQ(plc->status(0).fault.value().code, FaultCode::other_cycle);
  EXPECT_EQ(plc->status(1).fault.value().code, FaultCode::program_failed);
  EXPECT_EQ(plc->gate().frame().outputs, OutputGate::Outputs{});

  EXPECT_FALSE(plc->order_run(StartKind::cold)) << "a fault has to be reset";
  fails = false;
  EXPECT_TRUE(plc->order_reset());
  EXPECT_TRUE(plc->order_run(StartKind::warm));
  run_until(*plc, now, 101ms);
  EXPECT_FALSE(plc->alarm_lamp());
  EXPECT_GT(word(plc->gate().frame().outputs), 0U);
}

/// Calls `during` in the middle of a step of the cycle, as the watchdog's thread would run.
struct HangingPlc {
  std::function<void()> during;
  std::unique_ptr<SoftPlc> plc = make(two(cycle("hangs", 10ms, {}, 0,
                                                [this](const CycleImage& image, const ScanStep& step) {
                                                  count_on_outputs(image, step);
                                                  if (during) during();
                                                  return Progress::finished;
                                                }),
                                          cycle("other", 100ms, {}, 8, idle())));
};

// I2: equality is normal
TEST(SoftPlc, a_cycle_that_hangs_within_a_step_is_stopped_once_its_limit_has_passed_and_not_before) {
  HangingPlc rig;
  SoftPlc& plc = *rig.plc;
  ASSERT_TRUE(plc.order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(plc, now, 20ms);
  rig.during = [&] {
    const nanoseconds next = plc.supervise(now + 1ms);
    EXPECT_EQ(next, 20ms + 150ms + 1ns) << "the watchdog asks to be called right after the limit";
    plc.supervise(now + 150ms);
    EXPECT_FALSE(plc.alarm_lamp());
    plc.supervise(next);
    EXPECT_TRUE(plc.alarm_lamp());
    EXPECT_EQ(plc.gate().frame().outputs, OutputGate::Outputs{});
    EXPECT_FALSE(plc.order_reset()) << "it still hangs";
    EXPECT_FALSE(plc.order_run(StartKind::cold));
    rig.during = nullptr;
  };
  run_until(plc, now, 200ms);
  EXPECT_EQ(plc.status(0).fault.value().code, FaultCode::watchdog);
  EXPECT_EQ(plc.status(1).fault.value().code, FaultCode::other_cycle);
  EXPECT_EQ(plc.gate().frame().outputs, OutputGate::Outputs{});
  EXPECT_TRUE(plc.order_reset());
  EXPECT_TRUE(plc.order_run(StartKind::cold));
  run_until(plc, now, 300ms);
  EXPECT_FALSE(plc.alarm_lamp());
}

// I21
TEST(SoftPlc, the_watchdog_leaves_a_PLC_in_peace_whose_scans_keep_to_their_limit) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  for (nanoseconds now{0}; now < 2s; now += 1ms) {
    nanoseconds t = now;
    run_until(*plc, t, now + 1ms);
    plc->supervise(now);
  }
  EXPECT_FALSE(plc->alarm_lamp());
  EXPECT_EQ(word(plc->gate().frame().outputs), 200U);
}

TEST(SoftPlc, two_cycles_that_write_the_same_output_or_send_the_same_word_are_refused) {
  const auto refusal = [](PlcCycleSetup a, PlcCycleSetup b) {
    return SoftPlc::make(setup_of(two(std::move(a), std::move(b))), 0ns).error();
  };
  EXPECT_NE(refusal(cycle("a", 1ms, {}, 0, idle()), cycle("b", 1ms, {}, 4, idle())).find("same output"),
            std::string::npos);
  EXPECT_NE(
      refusal(cycle("a", 1ms, {0, 4}, 0, idle()), cycle("b", 1ms, {3, 2}, 8, idle())).find("same words"),
      std::string::npos);
}

TEST(SoftPlc, a_setup_that_cannot_be_run_is_refused_naming_the_cycle) {
  const auto refusal = [](SoftPlcSetup setup) { return SoftPlc::make(std::move(setup), 0ns).error(); };
  EXPECT_EQ(refusal(setup_of({})), "a PLC has 1 to 32 cycles");
  auto cycles = two(cycle("a", 1ms, {}, 0, idle()), cycle("b", 1ms, {}, 8, idle()));
  cycles[1].config.scan.outputs_in_stop = OutputsInStop::hold;
  EXPECT_NE(refusal(setup_of(std::move(cycles))).find("cycles a and b disagree about outputs in STOP"),
            std::string::npos);
  EXPECT_EQ(refusal(setup_of(one(cycle("a", 1ms, {250, 7}, 0, idle())))),
            "cycle a sends words that lie beyond its memory");
}

TEST(SoftPlc, RUN_that_is_ordered_in_RUN_changes_nothing) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 25ms);
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  EXPECT_EQ(word(plc->gate().frame().outputs), 3U);
  run_until(*plc, now, 35ms);
  EXPECT_EQ(word(plc->gate().frame().outputs), 4U);
}

TEST(SoftPlc, after_a_cold_start_the_others_receive_zero_until_the_first_scan_has_sent) {
  std::vector<std::uint64_t> received;
  const auto plc = make(two(cycle("sender", 10ms, {0, 8}, 0,
                                  [](const CycleImage& image, const ScanStep&) {
                                    set_word(image.memory, 7);
                                    return Progress::finished;
                                  }),
                            cycle("receiver", 10ms, {}, 8, [&](const CycleImage& image, const ScanStep&) {
                              received.push_back(word(image.memory));
                              return Progress::finished;
                            })));
  const auto run_scan = [&](std::size_t index, nanoseconds now) {
    while (plc->advance_cycle(index, now) <= now) {
    }
  };
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  for (const nanoseconds now : {0ms, 10ms, 20ms}) {
    if (now == 20ms) plc->order_stop();
    run_scan(0, now);
    run_scan(1, now);
  }
  EXPECT_EQ(received.back(), 7U);
  received.clear();
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  while (plc->status(0).mode == RunMode::stop) static_cast<void>(plc->advance_cycle(0, 30ms));
  run_scan(1, 30ms);
  EXPECT_EQ(received, std::vector<std::uint64_t>{0});
}

TEST(SoftPlc, a_body_is_told_that_its_scan_is_given_up) {
  class Loop final : public CycleBody {
   public:
    explicit Loop(int& given_up_count) : given_up_count_{given_up_count} {}
    CycleImage image() noexcept override { return {}; }
    std::span<const std::byte> output_mask() const noexcept override { return {}; }
    void start(StartKind /*kind*/) noexcept override {}
    Progress execute(const ScanStep& /*step*/) noexcept override { return Progress::unfinished; }
    void give_up_scan() noexcept override { ++given_up_count_; }

   private:
    int& given_up_count_;
  };
  int given_up_count = 0;
  const auto plc =
      make(one({.name = "loops", .config = {}, .sends = {}, .body = std::make_unique<Loop>(given_up_count)}));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  for (nanoseconds now{0}; !plc->alarm_lamp(); now += 10ms) static_cast<void>(plc->advance(now));
  EXPECT_EQ(given_up_count, 1);
}

TEST(SoftPlc, new_limits_of_the_gateway_count_in_RUN_and_a_wrong_number_of_cycles_is_refused) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  ASSERT_TRUE(plc->reconfigure({{.period = 10ms}}, {.queue_max = 1, .requests_per_scan_max = 1}));
  const GatewayRequest read{.cycle = 0, .items = {{.section = {0, 1}, .written = {}}}};
  EXPECT_TRUE(plc->gateway().submit(read));
  EXPECT_EQ(plc->gateway().submit(read).error(), GatewayError::queue_full);
  EXPECT_FALSE(plc->reconfigure({}, {}));
  EXPECT_FALSE(plc->reconfigure({{.period = 10ms}, {.period = 10ms}}, {}));
}

TEST(SoftPlc, stop_now_has_made_the_outputs_safe_when_it_returns) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 25ms);
  plc->stop_now();
  EXPECT_EQ(plc->gate().frame().outputs, OutputGate::Outputs{});
  run_until(*plc, now, 45ms);
  EXPECT_TRUE(plc->is_stopped());
}

TEST(SoftPlc, one_that_is_retired_takes_no_RUN_and_one_in_RUN_cannot_be_retired) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  nanoseconds now{0};
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  EXPECT_FALSE(plc->retire()) << "RUN is ordered";
  run_until(*plc, now, 5ms);
  plc->order_stop();
  EXPECT_FALSE(plc->retire()) << "no scan has carried out the STOP";
  run_until(*plc, now, 25ms);
  EXPECT_TRUE(plc->retire());
  EXPECT_TRUE(plc->retire());
  EXPECT_FALSE(plc->order_run(StartKind::cold));
}

TEST(SoftPlc, a_new_period_counts_from_the_next_scan_on_in_RUN) {
  const auto plc = make(one(cycle("a", 10ms, {}, 0, count_on_outputs)));
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 15ms);  // scans at 0, 10
  ASSERT_TRUE(plc->reconfigure({{.period = 2ms}}, {}));
  run_until(*plc, now, 25ms);  // 20, 22, 24
  EXPECT_EQ(word(plc->gate().frame().outputs), 5U);
  EXPECT_FALSE(plc->reconfigure({{.period = -1ms}}, {}));
}

// I23, exchange: each cycle on a thread of its own, in every interleaving that the seed draws.
TEST(SoftPlcProperty, in_any_interleaving_of_threads_a_cycle_sees_whole_sets_and_outputs_are_of_whole_scans) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    std::mt19937 choices{seed};
    const auto writer = [](std::size_t first, std::size_t output) {
      return [first, output, half = false](const CycleImage& image, const ScanStep&) mutable {
        const std::uint64_t count = word(image.memory, first) + (half ? 0 : 1);
        set_word(image.memory, count, first);
        if (half) set_word(image.memory, count, first + 8);
        image.outputs[output] = image.outputs[output + (half ? 1 : 0)] = std::byte(count);
        if (half) image.outputs[output + 1] = std::byte(count);
        // What the other has sent stays whole, and the same during the scan.
        const std::size_t other = 16 - first;
        EXPECT_EQ(word(image.memory, other), word(image.memory, other + 8));
        half = !half;
        return half ? Progress::unfinished : Progress::finished;
      };
    };
    const auto plc =
        make(two(cycle("a", 1ms, {0, 16}, 0, writer(0, 0)), cycle("b", 3ms, {16, 16}, 8, writer(16, 8))));
    nanoseconds now{0};
    for (int i = 0; i < 400; ++i) {
      const auto choice = choices() % 64;
      if (choice == 0) plc->order_stop();
      if (choice == 1 || i == 0) static_cast<void>(plc->order_run(StartKind::cold));
      plc->advance_cycle(choices() % 2, now);
      now += nanoseconds{choices() % 200'000};
      const auto frame = plc->gate().frame();
      ASSERT_EQ(frame.outputs[0], frame.outputs[1]) << "seed " << seed;
      ASSERT_EQ(frame.outputs[8], frame.outputs[9]) << "seed " << seed;
      if (plc->gate().is_open()) continue;
      ASSERT_EQ(frame.outputs, OutputGate::Outputs{}) << "seed " << seed;
    }
  }
}

class Threads : public testing::TestWithParam<PlcThreading> {};

// Real threads: nothing is said about times.
TEST_P(Threads, orders_exchange_and_gateway_hold_under_real_threads) {
  std::atomic<std::uint64_t> scans{0};
  std::atomic<bool> torn{false};
  const auto writer = [&](std::size_t first) {
    return [&, first](const CycleImage& image, const ScanStep&) {
      const std::uint64_t count = word(image.memory, first) + 1;
      set_word(image.memory, count, first);
      set_word(image.memory, count, first + 8);
      if (word(image.memory, 16 - first) != word(image.memory, 24 - first)) torn = true;
      ++scans;
      return Progress::finished;
    };
  };
  const auto plc =
      make(two(cycle("a", 100us, {0, 16}, 0, writer(0)), cycle("b", 300us, {16, 16}, 8, writer(16))));
  // Made at time 0 of a clock that has run for long: the first starts are lost, which is no fault with `skip`.
  SteadyPlcClock clock;
  PlcThreads threads{*plc, clock, GetParam(), true};
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(plc->order_run(StartKind::cold));
    const std::uint64_t before = scans;
    const auto answer =
        plc->gateway().exchange({.cycle = 0, .items = {{.section = {0, 16}, .written = {}}}}, 10s);
    ASSERT_TRUE(answer);
    EXPECT_EQ(word(answer->read[0]), word(answer->read[0], 8));
    while (scans == before) std::this_thread::yield();
    plc->order_stop();
  }
  threads.stop();
  EXPECT_FALSE(torn);
  EXPECT_FALSE(plc->gate().is_open());
}
INSTANTIATE_TEST_SUITE_P(Kinds, Threads, testing::Values(PlcThreading::one, PlcThreading::per_cycle));

// Periods of an hour: only the wake-up can be in time.
TEST(PlcThreads, a_driver_brings_safe_outputs_to_the_field_at_once_after_STOP_and_at_the_end) {
  for (const bool at_end : {false, true}) {
    std::atomic<std::uint64_t> terminals{0};
    std::atomic<int> exchanges{0};
    class Driver final : public IoDriver {
     public:
      Driver(std::atomic<std::uint64_t>& shown, std::atomic<int>& count) : terminals_{shown}, count_{count} {}
      bool exchange(const OutputGate::Frame& frame, OutputGate& gate,
                    std::span<std::byte> /*inputs*/) noexcept override {
        gate.write_through(frame, [this](const OutputGate::Outputs& outputs) { terminals_ = word(outputs); });
        ++count_;
        return true;
      }

     private:
      std::atomic<std::uint64_t>& terminals_;
      std::atomic<int>& count_;
    };
    auto setup = setup_of(one(cycle("a", 1ms, {}, 0, count_on_outputs)));
    IoManager::Slot& slot = setup.drivers.emplace_back();
    slot.config.period = 1h;
    slot.config.late_after = 1h;
    slot.driver = std::make_unique<Driver>(terminals, exchanges);
    SteadyPlcClock clock;
    const auto plc = SoftPlc::make(std::move(setup), clock.now()).value();
    ASSERT_TRUE(plc->order_run(StartKind::cold));
    // Outputs are there before the driver's first exchange, so that it shows them.
    while (word(plc->gate().frame().outputs) == 0) static_cast<void>(plc->advance(clock.now()));
    PlcThreads threads{*plc, clock, PlcThreading::one, false};
    while (exchanges == 0) std::this_thread::yield();
    EXPECT_GT(terminals, 0U);
    if (at_end) {
      threads.stop();
      EXPECT_EQ(terminals, 0U);
    } else {
      plc->order_stop();
      while (terminals != 0) std::this_thread::yield();
    }
  }
}

TEST(PlcThreads, the_watchdog_s_thread_stops_a_PLC_whose_cycle_hangs) {
  std::atomic<bool> released{false};
  auto cycles = one(cycle("hangs", 1ms, {}, 0, [&](const CycleImage&, const ScanStep&) {
    while (!released) std::this_thread::yield();
    return Progress::finished;
  }));
  cycles[0].config.scan.watchdog_limit = 5ms;
  const auto plc = make(std::move(cycles));
  SteadyPlcClock clock;
  PlcThreads threads{*plc, clock, PlcThreading::per_cycle, false};
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  while (!plc->alarm_lamp()) std::this_thread::yield();
  EXPECT_FALSE(plc->gate().is_open());
  released = true;
  threads.stop();
  EXPECT_EQ(threads.realtime_refusal(), "");
}

}  // namespace
}  // namespace emulator_models::soft_plc
