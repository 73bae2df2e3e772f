// The program of a cycle as the monitor wants it: two slices, each of which reads the inputs and writes half of the outputs.
// Its memory is two pairs of words: one that the program writes, a word a slice, so that they are equal between two scans;
// and one that field devices write through the gateway, whole.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "tests/scenarios/plc/shared_memory_driver.hpp"

namespace scenarios::soft_plc {

class WatchedBody final : public emulator_models::soft_plc::CycleBody {
 public:
  using CycleImage = emulator_models::soft_plc::CycleImage;
  using Progress = emulator_models::soft_plc::Progress;
  using ScanStep = emulator_models::soft_plc::ScanStep;
  using StartKind = emulator_models::soft_plc::StartKind;

  enum class Trouble : std::uint8_t { none, hangs_in_slice, endless_slices };
  struct Hang {
    Trouble trouble = Trouble::none;
    std::size_t scan = 0;  ///< from 1, over all runs
    std::chrono::microseconds duration{0};
    bool computes = false;  ///< instead of sleeping
  };

  WatchedBody(PlcMonitor& monitor, std::size_t cycle, PlcScene::Inputs inputs, const Hang& hang)
      : monitor_{monitor}, cycle_{cycle}, kind_{inputs}, hang_{hang} {
    std::fill_n(mask_.begin() + static_cast<std::ptrdiff_t>(4 * cycle), 4, std::byte{0xFF});
  }

  CycleImage image() noexcept override { return {inputs_, outputs_, memory_}; }
  std::span<const std::byte> output_mask() const noexcept override { return mask_; }
  void start(StartKind /*kind*/) noexcept override {
    begin_anew();
    monitor_.initialised(cycle_);
  }
  void give_up_scan() noexcept override {
    begin_anew();
    std::copy_n(memory_.begin(), 8, memory_.begin() + 8);
    monitor_.gave_up(cycle_);
  }

  Progress execute(const ScanStep& step) noexcept override {
    monitor_.slice_begins(cycle_, step.scan_start, step.first_scan);
    if (std::exchange(scan_is_new_, false)) ++scan_;
    monitor_.input_read(cycle_, input());
    monitor_.field_words_read(cycle_, word(16), word(24));
    const std::uint32_t wanted = monitor_.next_outputs(cycle_);
    const std::size_t half = slice_ == 0 ? 0 : 2;
    std::memcpy(&outputs_[4 * cycle_ + half], reinterpret_cast<const std::byte*>(&wanted) + half, 2);
    const std::uint64_t number = wanted;
    std::memcpy(&memory_[slice_ == 0 ? 0 : 8], &number, sizeof number);
    if (is_held_up()) return Progress::unfinished;
    if (++slice_ < 2) return Progress::unfinished;
    begin_anew();
    monitor_.scan_computed(cycle_);
    return Progress::finished;
  }

 private:
  void begin_anew() noexcept {
    slice_ = 0;
    scan_is_new_ = true;
  }

  [[nodiscard]] std::uint64_t input() const noexcept {
    if (kind_ == PlcScene::Inputs::live) return card_->inputs;
    std::uint64_t latched = 0;
    std::memcpy(&latched, inputs_.data(), sizeof latched);
    return latched;
  }

  [[nodiscard]] std::uint64_t word(std::size_t first) const noexcept {
    std::uint64_t value = 0;
    std::memcpy(&value, &memory_[first], sizeof value);
    return value;
  }

  /// @return whether the slice has to be done again
  bool is_held_up() noexcept {
    constexpr std::chrono::milliseconds slice{5};
    if (hang_.trouble == Trouble::none || scan_ != hang_.scan ||
        hang_.duration <= std::chrono::microseconds{0})
      return false;
    const bool in_slice = hang_.trouble == Trouble::hangs_in_slice;
    const std::chrono::microseconds duration = in_slice ? hang_.duration : slice;
    if (hang_.computes) {
      compute(duration);
    } else {
      std::this_thread::sleep_for(duration);
    }
    hang_.duration -= duration;
    return !in_slice;
  }

  void compute(std::chrono::microseconds duration) noexcept {
    std::atomic<unsigned> steps{0};
    const auto end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end) {
      for (int i = 0; i < 10; ++i) ++steps;
      monitor_.computes();
    }
  }

  const Card card_{card_segment};
  PlcMonitor& monitor_;
  const std::size_t cycle_;
  const PlcScene::Inputs kind_;
  Hang hang_;
  std::size_t scan_ = 0;  ///< the one under way, or the latest
  bool scan_is_new_ = true;
  unsigned slice_ = 0;
  std::array<std::byte, 8> inputs_{};
  std::array<std::byte, 8> outputs_{};
  std::array<std::byte, 8> mask_{};
  std::array<std::byte, 32> memory_{};
};

}  // namespace scenarios::soft_plc
