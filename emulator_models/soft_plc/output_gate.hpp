// The one way from the output images of the cycles to the terminals.
//
// Each start of RUN opens the gate under a new run number, and whoever commits names the run its scan belongs to.
// A stop closes the gate and sets the safe values in the same critical section, so nothing of that run follows.
//
// Invariants
//   I1  (I19) from close to the next open, the outputs are the safe values and do not change.
//   I2  (I24) of each cycle the outputs are those of one whole scan of this run, or the safe ones.
//   I3  a commit or a close that names an older run does nothing but be counted.
//   I4  a frame that was taken before the latest open or close does not get through write_through.
// Any thread; no allocation after construction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "emulator_models/soft_plc/inheriting_mutex.hpp"

namespace emulator_models::soft_plc {

class OutputGate {
 public:
  using Outputs = std::array<std::byte, outputs_bytes_max>;
  /// One committed set on its way to a driver.
  struct Frame {
    std::uint64_t epoch = 0;
    Outputs outputs{};
  };

  /// Closed, with the safe values.
  explicit OutputGate(const Outputs& safe) noexcept : safe_{safe}, outputs_{safe} {}

  /// A new run. Outputs of a run that was not closed become safe, or are held.
  /// @return its number, never one that was there before
  std::uint64_t open(bool hold_outputs) noexcept;
  /// @param mask     the bits that the committing cycle writes
  /// @param outputs  of the length of the mask, at most outputs_bytes_max
  /// @return         whether the outputs were written; false = dropped
  bool commit(std::uint64_t run, std::span<const std::byte> mask,
              std::span<const std::byte> outputs) noexcept;
  /// @return whether the gate was open for that run
  bool close(std::uint64_t run) noexcept;

  [[nodiscard]] Frame frame() const noexcept;
  /// For the last writer before the hardware: write() is called within the critical section, if nothing was
  /// stopped or started since the frame was taken. It must only copy.
  /// @return whether it was called
  template <typename Write>
  bool write_through(const Frame& frame, Write&& write) noexcept {
    const std::lock_guard lock{mutex_};
    if (frame.epoch != epoch_) return false;
    write(frame.outputs);
    return true;
  }

  /// Called whenever the outputs have become safe, within the critical section; it must not call the gate.
  void on_safe(std::function<void()> listener) noexcept;

  [[nodiscard]] bool is_open() const noexcept;
  [[nodiscard]] std::uint64_t dropped_commits_count() const noexcept;

 private:
  /// Under the lock.
  void make_safe() noexcept;

  const Outputs safe_;
  mutable InheritingMutex mutex_;
  // All guarded by mutex_.
  Outputs outputs_;
  std::uint64_t epoch_ = 0;  ///< counts opens and closes; while open, the run number
  bool open_ = false;
  std::uint64_t dropped_commits_count_ = 0;
  std::function<void()> on_safe_;
};

}  // namespace emulator_models::soft_plc
