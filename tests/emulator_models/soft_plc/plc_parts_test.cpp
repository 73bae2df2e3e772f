// The parts that cycles share, one by one: output gate, drivers, gateway.
#include <gtest/gtest.h>

#include "tests/emulator_models/soft_plc/counted_allocations.hpp"
#include "tests/emulator_models/soft_plc/plc_rig.hpp"

namespace emulator_models::soft_plc {
namespace {

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

OutputGate::Outputs all(std::uint8_t value) {
  OutputGate::Outputs outputs;
  outputs.fill(std::byte{value});
  return outputs;
}

const OutputGate::Outputs safe = all(0xA5);
const OutputGate::Outputs every_bit = all(0xFF);

// I3
TEST(OutputGate, a_commit_of_an_older_run_is_dropped_and_counted) {
  OutputGate gate{safe};
  const auto first = gate.open(false);
  ASSERT_TRUE(gate.commit(first, every_bit, all(1)));
  ASSERT_TRUE(gate.close(first));
  EXPECT_EQ(gate.frame().outputs, safe);
  EXPECT_FALSE(gate.commit(first, every_bit, all(2)));
  const auto second = gate.open(false);
  EXPECT_FALSE(gate.commit(first, every_bit, all(3)));
  EXPECT_FALSE(gate.close(first)) << "a late stop of the old run does not end the new one";
  EXPECT_EQ(gate.frame().outputs, safe);
  EXPECT_TRUE(gate.commit(second, every_bit, all(4)));
  EXPECT_EQ(gate.dropped_commits_count(), 2U);
}

TEST(OutputGate, a_cycle_writes_its_own_bits_only) {
  OutputGate gate{OutputGate::Outputs{}};
  const auto run = gate.open(false);
  gate.commit(run, all(0x0F), every_bit);
  gate.commit(run, all(0xF0), all(0x50));
  EXPECT_EQ(gate.frame().outputs, all(0x5F));
}

// I4
TEST(OutputGate, a_frame_that_a_stop_has_overtaken_does_not_reach_the_hardware) {
  OutputGate gate{safe};
  const auto run = gate.open(false);
  gate.commit(run, every_bit, all(1));
  const auto late = gate.frame();
  OutputGate::Outputs hardware = all(0);
  const auto write = [&](const OutputGate::Outputs& outputs) { hardware = outputs; };
  EXPECT_TRUE(gate.write_through(late, write));
  gate.close(run);
  EXPECT_TRUE(gate.write_through(gate.frame(), write));
  EXPECT_FALSE(gate.write_through(late, write));
  EXPECT_EQ(hardware, safe);
}

TEST(OutputGate, a_restart_makes_outputs_safe_unless_they_are_held) {
  OutputGate gate{safe};
  gate.commit(gate.open(false), every_bit, all(1));
  gate.open(true);
  EXPECT_EQ(gate.frame().outputs, all(1));
  gate.open(false);
  EXPECT_EQ(gate.frame().outputs, safe);
}

struct Field {
  explicit Field(std::vector<ScriptedDriver::Turn> script, DriverConfig config = {}) {
    auto owned = std::make_unique<ScriptedDriver>(std::move(script));
    driver = owned.get();
    config.inputs = {0, 4};
    config.late_after = 50ms;
    config.stale_bit = 40;
    std::vector<IoManager::Slot> slots;
    slots.push_back({config, std::move(owned)});
    io.emplace(std::move(slots), 0ns);
  }
  void exchange(nanoseconds now) {
    io->exchange(0, gate, [now] { return now; });
  }
  std::vector<std::byte> latched() const {
    std::vector<std::byte> inputs(8);
    io->latch(inputs);
    return inputs;
  }
  OutputGate gate{safe};
  ScriptedDriver* driver = nullptr;
  std::optional<IoManager> io;
};

TEST(IoManager, a_failed_exchange_leaves_the_last_good_inputs_and_their_age) {
  Field field({{.input = std::byte{7}}, {.input = std::byte{9}, .good = false}});
  field.exchange(10ms);
  field.exchange(20ms);
  EXPECT_EQ(field.latched()[0], std::byte{7});
  EXPECT_EQ(field.io->state(0, 25ms).age, 15ms);
  EXPECT_EQ(field.io->state(0, 25ms).failures_count, 1U);
  EXPECT_FALSE(field.io->state(0, 25ms).stale);
}

TEST(IoManager, inputs_are_stale_after_so_many_failures_in_a_row_and_good_again_with_the_next_good_exchange) {
  Field field({{.good = false}, {.good = false}, {.good = false}, {.input = std::byte{1}}});
  field.exchange(1ms);
  field.exchange(2ms);
  EXPECT_EQ(field.latched()[5], std::byte{0});
  field.exchange(3ms);
  EXPECT_EQ(field.latched()[5], std::byte{1}) << "the bit that tells the program";
  field.exchange(4ms);
  EXPECT_EQ(field.latched()[5], std::byte{0});
  EXPECT_EQ(field.io->state(0, 4ms).stale_count, 1U);
}

TEST(IoManager, failures_count_in_a_row_only) {
  Field field({{.good = false}, {.good = false}, {}, {.good = false}, {.good = false}, {}});
  for (int i = 1; i <= 6; ++i) field.exchange(i * 1ms);
  EXPECT_EQ(field.io->state(0, 6ms).stale_count, 0U);
  EXPECT_EQ(field.io->state(0, 6ms).failures_count, 4U);
}

TEST(IoManager, a_late_driver_is_stale_once_its_time_has_passed_and_not_at_it) {
  Field field(std::vector<ScriptedDriver::Turn>(1));
  field.exchange(10ms);
  EXPECT_EQ(field.io->next_look(), 60ms + 1ns);
  field.io->supervise(60ms);
  EXPECT_FALSE(field.io->state(0, 60ms).stale);
  field.io->supervise(60ms + 1ns);
  field.io->supervise(70ms);
  EXPECT_TRUE(field.io->state(0, 70ms).stale);
  EXPECT_EQ(field.io->state(0, 70ms).stale_count, 1U);
}

TEST(IoManager, a_driver_that_was_slow_does_not_bring_outputs_of_before_a_stop) {
  std::uint64_t run = 0;
  Field* at = nullptr;
  Field field({{.delay = [&] { at->gate.close(run); }}, {}});
  at = &field;
  run = field.gate.open(false);
  field.gate.commit(run, every_bit, all(1));
  field.exchange(1ms);
  EXPECT_EQ(field.driver->terminals, OutputGate::Outputs{}) << "nothing has reached it";
  field.exchange(2ms);
  EXPECT_EQ(field.driver->terminals, safe);
}

ScriptedBody::Run idle() {
  return [](const CycleImage&, const ScanStep&) { return Progress::finished; };
}

TEST(IoManager, stale_inputs_stop_the_PLC_if_that_is_asked_for) {
  SoftPlcSetup setup;
  setup.cycles.push_back(cycle("a", 10ms, {}, 0, idle()));
  setup.slice_intervals = {0ns};
  DriverConfig config;
  config.late_after = 30ms;
  config.stale_is_fault = true;
  IoManager::Slot& slot = setup.drivers.emplace_back();
  slot.config = config;
  slot.driver = std::make_unique<ScriptedDriver>(std::vector<ScriptedDriver::Turn>(1));
  const auto plc = SoftPlc::make(std::move(setup), 0ns).value();
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 31ms);
  plc->supervise(30ms);
  EXPECT_TRUE(plc->gate().is_open());
  plc->supervise(31ms);
  EXPECT_FALSE(plc->gate().is_open());
  run_until(*plc, now, 50ms);
  EXPECT_EQ(plc->status(0).fault.value().code, FaultCode::io_failed);
}

TEST(IoManager, stale_inputs_stop_no_PLC_that_only_counts_them_and_none_that_is_in_STOP) {
  for (const bool is_fault : {false, true}) {
    SoftPlcSetup setup = setup_of({});
    setup.cycles.push_back(cycle("a", 10ms, {}, 0, idle()));
    IoManager::Slot& slot = setup.drivers.emplace_back();
    slot.config.late_after = 30ms;
    slot.config.stale_is_fault = is_fault;
    slot.driver = std::make_unique<ScriptedDriver>(std::vector<ScriptedDriver::Turn>(1));
    const auto plc = SoftPlc::make(std::move(setup), 0ns).value();
    if (!is_fault) {
      ASSERT_TRUE(plc->order_run(StartKind::cold));
    }
    nanoseconds now{0};
    run_until(*plc, now, 40ms);
    plc->supervise(now);
    EXPECT_TRUE(plc->io().state(0, now).stale);
    EXPECT_FALSE(plc->alarm_lamp()) << is_fault;
  }
}

// I23
TEST(IoManager, inputs_do_not_change_within_a_scan) {
  SoftPlc* at = nullptr;
  std::vector<std::byte> seen;
  std::vector<PlcCycleSetup> cycles;
  cycles.push_back(cycle("a", 10ms, {}, 0, [&](const CycleImage& image, const ScanStep&) {
    seen.push_back(image.inputs[0]);
    at->io().exchange(0, at->gate(), [] { return 1ms; });
    seen.push_back(image.inputs[0]);
    return seen.size() % 4 == 0 ? Progress::finished : Progress::unfinished;
  }));
  auto setup = setup_of(std::move(cycles));
  IoManager::Slot& slot = setup.drivers.emplace_back();
  slot.config.inputs = {0, 1};
  slot.driver = std::make_unique<ScriptedDriver>(std::vector<ScriptedDriver::Turn>{
      {.input = std::byte{1}}, {.input = std::byte{2}}, {.input = std::byte{3}}});
  const auto plc = SoftPlc::make(std::move(setup), 0ns).value();
  at = plc.get();
  ASSERT_TRUE(plc->order_run(StartKind::cold));
  nanoseconds now{0};
  run_until(*plc, now, 5ms);
  EXPECT_EQ(seen, (std::vector<std::byte>(4, std::byte{0})));
  run_until(*plc, now, 15ms);
  EXPECT_EQ(seen[4], std::byte{2}) << "the latest one, in the next scan";
}

/// Two cycles; the first counts in word 0 and shows word 64 as it saw it in its latest scan.
struct Served {
  std::uint64_t seen_in_scan = 0;
  std::function<void()> in_mid_scan;
  std::unique_ptr<SoftPlc> plc = [this] {
    std::vector<PlcCycleSetup> cycles;
    cycles.push_back(cycle("a", 10ms, {0, 8}, 0, [this](const CycleImage& image, const ScanStep&) {
      set_word(image.memory, word(image.memory) + 1);
      if (in_mid_scan) in_mid_scan();
      seen_in_scan = word(image.memory, 64);
      return Progress::finished;
    }));
    cycles.push_back(cycle("b", 10ms, {8, 8}, 8, idle()));
    auto setup = setup_of(std::move(cycles));
    setup.gateway = {.queue_max = 3, .requests_per_scan_max = 2};
    return SoftPlc::make(std::move(setup), 0ns).value();
  }();
  nanoseconds now{0};

  static GatewayRequest read(Section section) {
    return {.cycle = 0, .items = {{.section = section, .written = {}}}};
  }
  static GatewayRequest write(std::size_t first) {
    return {.cycle = 0, .items = {{.section = {first, 0}, .written = {std::byte{5}}}}};
  }
};

// I2
TEST(Gateway, a_write_that_comes_in_mid_scan_is_seen_in_the_next_scan_only) {
  Served served;
  ASSERT_TRUE(served.plc->order_run(StartKind::cold));
  run_until(*served.plc, served.now, 15ms);
  std::shared_ptr<Gateway::Ticket> ticket;
  served.in_mid_scan = [&] {
    ticket = served.plc->gateway().submit(Served::write(64)).value();
    served.in_mid_scan = nullptr;
  };
  run_until(*served.plc, served.now, 25ms);
  EXPECT_EQ(served.seen_in_scan, 0U);
  EXPECT_EQ(served.plc->gateway().take(ticket, true).error(), GatewayError::timed_out);
  run_until(*served.plc, served.now, 35ms);
  EXPECT_EQ(served.seen_in_scan, 5U);
  EXPECT_TRUE(served.plc->gateway().take(ticket));
}

TEST(Gateway, items_of_a_request_see_one_image_in_their_order) {
  Served served;
  GatewayRequest request = Served::write(64);
  request.items.push_back({.section = {64, 1}, .written = {}});
  const auto ticket = served.plc->gateway().submit(request).value();
  run_until(*served.plc, served.now, 5ms);
  EXPECT_EQ(served.plc->gateway().take(ticket).value().read[1], std::vector<std::byte>{std::byte{5}});
}

TEST(Gateway, a_full_queue_refuses_and_a_scan_serves_no_more_than_its_share) {
  Served served;
  Gateway& gateway = served.plc->gateway();
  std::vector<std::shared_ptr<Gateway::Ticket>> tickets;
  for (int i = 0; i < 3; ++i) tickets.push_back(gateway.submit(Served::read({0, 8})).value());
  EXPECT_EQ(gateway.submit(Served::read({0, 8})).error(), GatewayError::queue_full);
  EXPECT_EQ(gateway.refused_count(), 1U);
  run_until(*served.plc, served.now, 5ms);
  EXPECT_TRUE(gateway.take(tickets[1]));
  EXPECT_EQ(gateway.take(tickets[2], true).error(), GatewayError::timed_out);
  run_until(*served.plc, served.now, 15ms);
  EXPECT_TRUE(gateway.take(tickets[2]));
}

// I3
TEST(Gateway, a_request_that_was_given_up_is_not_carried_out) {
  Served served;
  ASSERT_TRUE(served.plc->order_run(StartKind::warm));
  run_until(*served.plc, served.now, 5ms);
  EXPECT_EQ(served.plc->gateway().exchange(Served::write(64), 0ns).error(), GatewayError::timed_out);
  run_until(*served.plc, served.now, 25ms);
  EXPECT_EQ(served.seen_in_scan, 0U);
}

TEST(Gateway, a_write_of_one_bit_leaves_the_other_bits_alone) {
  Served served;
  GatewayRequest request = Served::write(64);
  request.items[0].written = {std::byte{0xA5}};
  const auto bit = [&](std::uint8_t index, std::uint8_t value) {
    request.items.push_back({.section = {64, 0}, .written = {std::byte{value}}, .bit = index});
  };
  bit(1, 1);
  bit(0, 0);
  bit(7, 9);
  request.items.push_back({.section = {64, 1}, .written = {}});
  const auto ticket = served.plc->gateway().submit(request).value();
  run_until(*served.plc, served.now, 5ms);
  EXPECT_EQ(served.plc->gateway().take(ticket).value().read[4], std::vector<std::byte>{std::byte{0xA6}});
}

// I5
TEST(Gateway, a_scan_that_serves_requests_takes_no_memory_and_gives_none_back) {
  Served served;
  GatewayRequest request = Served::write(64);
  request.items.push_back({.section = {0, 200}, .written = {}});
  std::vector<std::shared_ptr<Gateway::Ticket>> tickets;
  for (int i = 0; i < 3; ++i) tickets.push_back(served.plc->gateway().submit(request).value());
  const std::uint64_t before = heap_calls_count();
  run_until(*served.plc, served.now, 25ms);
  EXPECT_EQ(heap_calls_count(), before);
  for (const auto& ticket : tickets)
    EXPECT_EQ(served.plc->gateway().take(ticket).value().read[1].size(), 200U);
}

TEST(Gateway, a_request_is_bounded_in_items_and_in_bytes) {
  Served served;
  GatewayRequest request = Served::read({0, 1});
  request.items.resize(GatewayRequest::items_max, request.items[0]);
  EXPECT_TRUE(served.plc->gateway().submit(request));
  request.items.push_back(request.items[0]);
  EXPECT_EQ(served.plc->gateway().submit(request).error(), GatewayError::request_too_long);
  request = Served::read({0, 256});
  request.items.resize(4, request.items[0]);
  EXPECT_TRUE(served.plc->gateway().submit(request));
  request.items.push_back(Served::read({0, 1}).items[0]);
  EXPECT_EQ(served.plc->gateway().submit(request).error(), GatewayError::request_too_long);
}

TEST(Gateway, who_waits_when_it_is_closed_is_told) {
  Served served;
  const auto ticket = served.plc->gateway().submit(Served::read({0, 8})).value();
  served.plc->gateway().close();
  EXPECT_EQ(served.plc->gateway().take(ticket, true).error(), GatewayError::closed);
}

TEST(Gateway, what_cannot_be_served_is_refused_before_it_waits) {
  Served served;
  const auto refusal = [&](GatewayRequest request) {
    return served.plc->gateway().submit(std::move(request)).error();
  };
  EXPECT_EQ(refusal({.cycle = 2, .items = {}}), GatewayError::cycle_unknown);
  EXPECT_EQ(refusal({.cycle = 0, .items = {}}), GatewayError::request_too_long);
  EXPECT_EQ(refusal(Served::read({250, 7})), GatewayError::out_of_range);
  EXPECT_EQ(refusal(Served::read({~std::size_t{0}, 2})), GatewayError::out_of_range);
  EXPECT_EQ(refusal(Served::read({0, 0})), GatewayError::out_of_range);
  EXPECT_EQ(refusal(Served::write(8)), GatewayError::owned_by_other_cycle);
  GatewayRequest input = Served::write(0);
  input.items[0].area = Area::inputs;
  EXPECT_EQ(refusal(input), GatewayError::not_writable);
  GatewayRequest bit = Served::write(0);
  bit.items[0].bit = std::uint8_t{8};
  EXPECT_EQ(refusal(bit), GatewayError::bad_bit);
  bit.items[0] = {.section = {0, 1}, .written = {}, .bit = std::uint8_t{0}};
  EXPECT_EQ(refusal(bit), GatewayError::bad_bit);
  served.plc->gateway().close();
  EXPECT_EQ(refusal(Served::read({0, 8})), GatewayError::closed);
}

}  // namespace
}  // namespace emulator_models::soft_plc
