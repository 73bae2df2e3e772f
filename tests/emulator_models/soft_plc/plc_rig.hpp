// A soft PLC with scripted bodies and drivers, in simulated time on one thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "emulator_models/soft_plc/soft_plc.hpp"

namespace emulator_models::soft_plc {

/// A cycle whose slice is whatever the test says. Owns output bytes [first, first + 8).
class ScriptedBody final : public CycleBody {
 public:
  using Run = std::function<Progress(const CycleImage&, const ScanStep&)>;
  ScriptedBody(std::size_t first_output, Run run) : run_{std::move(run)} {
    if (first_output + 8 <= mask_.size())
      std::fill_n(mask_.begin() + static_cast<std::ptrdiff_t>(first_output), 8, std::byte{0xFF});
  }
  CycleImage image() noexcept override { return {inputs_, outputs_, memory_}; }
  std::span<const std::byte> output_mask() const noexcept override { return mask_; }
  void start(StartKind /*kind*/) noexcept override { std::ranges::fill(memory_, std::byte{0}); }
  Progress execute(const ScanStep& step) noexcept override { return run_(image(), step); }
  void give_up_scan() noexcept override {}

 private:
  Run run_;
  std::vector<std::byte> inputs_ = std::vector<std::byte>(inputs_bytes_max);
  std::vector<std::byte> outputs_ = std::vector<std::byte>(outputs_bytes_max);
  std::vector<std::byte> memory_ = std::vector<std::byte>(256);
  std::vector<std::byte> mask_ = std::vector<std::byte>(outputs_bytes_max);
};

/// Each exchange does what the script's next entry says, the last one for ever.
class ScriptedDriver final : public IoDriver {
 public:
  struct Turn {
    std::byte input{0};
    bool good = true;
    std::function<void()> delay{};  ///< between taking the frame and writing it
  };
  explicit ScriptedDriver(std::vector<Turn> script) : script_{std::move(script)} {}
  bool exchange(const OutputGate::Frame& frame, OutputGate& gate,
                std::span<std::byte> inputs) noexcept override {
    const Turn& turn = script_[std::min(next_++, script_.size() - 1)];
    if (turn.delay) turn.delay();
    gate.write_through(frame, [this](const OutputGate::Outputs& outputs) { terminals = outputs; });
    std::ranges::fill(inputs, turn.input);
    return turn.good;
  }
  OutputGate::Outputs terminals{};

 private:
  std::vector<Turn> script_;
  std::size_t next_ = 0;
};

inline PlcCycleSetup cycle(std::string name, std::chrono::nanoseconds period, Section sends,
                           std::size_t first_output, ScriptedBody::Run run) {
  return {.name = std::move(name),
          .config = {.scan = {.period = period}, .priority = 0},
          .sends = sends,
          .body = std::make_unique<ScriptedBody>(first_output, std::move(run))};
}

inline SoftPlcSetup setup_of(std::vector<PlcCycleSetup> cycles) {
  SoftPlcSetup setup;
  setup.cycles = std::move(cycles);
  setup.slice_intervals = {std::chrono::nanoseconds{0}};
  return setup;
}

inline std::uint64_t word(std::span<const std::byte> from, std::size_t at = 0) {
  std::uint64_t value = 0;
  std::memcpy(&value, from.data() + at, sizeof value);
  return value;
}
inline void set_word(std::span<std::byte> to, std::uint64_t value, std::size_t at = 0) {
  std::memcpy(to.data() + at, &value, sizeof value);
}

/// Runs all cycles on "one thread" up to a time.
inline void run_until(SoftPlc& plc, std::chrono::nanoseconds& now, std::chrono::nanoseconds end) {
  while (now < end) {
    const auto due = plc.advance(now);
    if (due > now) now = std::min(due, end);
  }
}

}  // namespace emulator_models::soft_plc
