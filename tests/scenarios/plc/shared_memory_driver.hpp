// A driver for a card whose terminals lie in shared memory: one word of inputs, one of outputs, each taken over at once.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <thread>

#include "emulator_models/soft_plc/io_driver.hpp"
#include "tests/scenarios/plc/plc_monitor.hpp"
#include "tests/scenarios/plc/plc_scene.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace scenarios::soft_plc {

struct Terminals {
  std::atomic<std::uint64_t> inputs;
  std::atomic<std::uint64_t> outputs;  ///< 32 bits for each cycle
};
using Card = races::Shared<Terminals>;
inline constexpr const char* card_segment = "card";

class SharedMemoryDriver final : public emulator_models::soft_plc::IoDriver {
 public:
  enum class Trouble : std::uint8_t { none, late, fails };

  /// @param trouble  asked at each exchange
  /// @param lateness  of an exchange that is late
  SharedMemoryDriver(PlcMonitor& monitor, PlcScene::Driver kind, std::function<Trouble()> trouble,
                     std::chrono::microseconds lateness)
      : monitor_{monitor}, kind_{kind}, trouble_{std::move(trouble)}, lateness_{lateness} {}

  bool exchange(const emulator_models::soft_plc::OutputGate::Frame& frame,
                emulator_models::soft_plc::OutputGate& gate, std::span<std::byte> inputs) noexcept override {
    const Trouble trouble = trouble_();
    if (trouble == Trouble::late) std::this_thread::sleep_for(lateness_);
    std::uint64_t wanted = 0;
    std::memcpy(&wanted, frame.outputs.data(), sizeof wanted);
    write(wanted, frame, gate);
    if (trouble == Trouble::fails) return false;
    const std::uint64_t read = card_->inputs;
    std::memcpy(inputs.data(), &read, sizeof read);
    return true;
  }

 private:
  void write(std::uint64_t wanted, const emulator_models::soft_plc::OutputGate::Frame& frame,
             emulator_models::soft_plc::OutputGate& gate) noexcept {
    constexpr std::uint64_t low_word = 0xFFFF'FFFF;
    switch (kind_) {
      case PlcScene::Driver::through_gate:
        gate.write_through(frame, [&](const auto& /*outputs*/) { show(wanted); });
        break;
      case PlcScene::Driver::past_gate:
        show(wanted);
        break;
      case PlcScene::Driver::word_by_word:
        for (const std::uint64_t word : {low_word, ~low_word})
          gate.write_through(
              frame, [&](const auto& /*outputs*/) { show((card_->outputs & ~word) | (wanted & word)); });
        break;
    }
  }

  void show(std::uint64_t outputs) noexcept {
    card_->outputs = outputs;
    monitor_.terminals_written(
        {static_cast<std::uint32_t>(outputs), static_cast<std::uint32_t>(outputs >> 32U)});
  }

  const Card card_{card_segment};
  PlcMonitor& monitor_;
  const PlcScene::Driver kind_;
  const std::function<Trouble()> trouble_;
  const std::chrono::microseconds lateness_;
};

}  // namespace scenarios::soft_plc
