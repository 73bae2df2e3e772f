// The published handoff as an object: a PLC that adds and reads, used by a kernel over the segment and looked at
// by a panel beside the emulator (F8). What they were answered is checked against a counter.
//
// The monitors of paper_scenarios.cpp know the protocol and name the broken rule. Here nothing is known but what
// went in and what came out, as a kernel sees it; a request that was given up may have taken effect.

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "emulator_models/emulator_handler.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "protocol/shared_memory_port.hpp"
#include "protocol/slave_shared_memory_wrapper.hpp"
#include "sim_clock/check/history.hpp"
#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/segment_names.hpp"

namespace {

using namespace std::chrono_literals;
using protocol::PaperOptions;

/// A device register that is read, or added to and read.
struct DeviceRegister {
  using State = unsigned;
  struct Operation {
    unsigned added = 0;  ///< 0: it reads
  };
  using Result = unsigned;  // the value after it

  static State initial() { return 0; }
  static std::optional<State> step(const State& state, const Operation& operation, const Result* result) {
    const State next = state + operation.added;
    return result == nullptr || *result == next ? std::optional{next} : std::nullopt;
  }
  static std::string operation_text(const Operation& operation) {
    return operation.added == 0 ? "read" : "add " + std::to_string(operation.added);
  }
  static std::string result_text(const Result& result) { return std::to_string(result); }
};

using DeviceHistory = ltsim::History<DeviceRegister>;

/// A request is what to add, one byte, or nothing but the byte 0; the answer is the value after it.
class RegisterPlc final : public emulator_models::IPlcEmulator {
 public:
  protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override {
    protocol::fx::FrameBytes answer;
    if (request.size() == 1) {
      const auto added = std::to_integer<std::uint8_t>(request.front());
      answer.push_back(std::byte{static_cast<std::uint8_t>(value_.fetch_add(added) + added)});
    }
    return answer;
  }
  [[nodiscard]] unsigned shown() const noexcept { return value_.load(); }

 private:
  std::atomic<std::uint8_t> value_ = 0;
};

/// One request over the port, as a kernel that knows nothing of sequence numbers makes it.
void request(protocol::SharedMemoryPort& port, DeviceHistory& history, unsigned added) {
  const auto call = history.call({.added = added});
  const std::byte bytes[1] = {static_cast<std::byte>(added)};
  std::byte answer[1];
  const auto length = port.write(bytes).and_then([&](std::size_t) { return port.read(answer); });
  if (length && *length == 1) {
    history.returned(call, std::to_integer<unsigned>(answer[0]));
  } else {
    history.timed_out(call);
  }
}

void run_register(ltsim::World& world, PaperOptions options) {
  constexpr const char* segment = "handoff";
  options.request_bytes_max = 4;
  options.response_bytes_max = 4;
  scenarios::name_regions(world, segment, options);
  DeviceHistory history;
  RegisterPlc plc;
  protocol::SlaveSharedMemoryWrapper slave{segment, options};
  emulator_models::EmulatorHandler handler{slave, plc};

  world.process("kernel").start("main", [&] {
    protocol::SharedMemoryPort port{segment, options};
    if (!port.open()) return;
    for (const unsigned added : {1U, 0U, 2U, 0U}) request(port, history, added);
    std::this_thread::sleep_for(50ms);  // what is late comes now
    handler.request_stop();
  });
  world.process("emulator").start("main", [&] {
    if (slave.open()) handler.run();
  });
  world.process("emulator").start("panel", [&] {
    for (int i = 0; i < 2; ++i) {
      const auto call = history.call({.added = 0});
      history.returned(call, plc.shown());
      std::this_thread::sleep_for(1ms);
    }
  });
  world.run();
  history.check_at_end(world);
}

}  // namespace

SCENARIO("paper/register", "requests as operations on a register, without time-outs: linearizable") {
  PaperOptions options;
  options.on_time_out = PaperOptions::OnTimeOut::wait_for_ever;
  run_register(world, options);
}

SCENARIO("paper/register-time-out", "the same with time-outs, after which the next request follows") {
  run_register(world, {});
}

SCENARIO("paper/register-send-again", "the same with time-outs, after which the request is sent again") {
  PaperOptions options;
  options.on_time_out = PaperOptions::OnTimeOut::send_again;
  run_register(world, options);
}
