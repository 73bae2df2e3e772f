// The inputs that drivers bring, with their age, and how the drivers are doing.
//
// Drivers run in parallel with the cycles and with one another. A driver that is late or fails leaves its last good
// inputs standing; after `late_after` without a good exchange, or `failures_max` failures in a row, they are stale
// until the next good one.
//
// Invariants
//   I1  (I23) cycles see inputs by latch() only; what drivers bring meanwhile waits for the next one.
//   I2  inputs of one driver are all of one exchange.
//   I3  each change to stale is counted once; so is each failure.
// Any thread; exchange() of one driver on one thread at a time. The lock is not held while a driver works.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator_models/soft_plc/inheriting_mutex.hpp"
#include "emulator_models/soft_plc/io_driver.hpp"

namespace emulator_models::soft_plc {

struct DriverConfig {
  std::string name;
  Section inputs{};  ///< of %I; within inputs_bytes_max, apart from those of other drivers
  std::chrono::nanoseconds period{std::chrono::milliseconds{1}};  ///< above 0
  std::chrono::nanoseconds late_after{
      std::chrono::milliseconds{100}};  ///< since the latest good exchange; above 0
  std::uint32_t failures_max = 3;       ///< in a row; at least 1
  bool stale_is_fault = false;
  /// Bit of %I, counted from %IX0.0, that tells the program that the inputs are stale; in no driver's section.
  std::optional<std::size_t> stale_bit{};
};

struct DriverState {
  std::chrono::nanoseconds age{0};  ///< of the inputs: since the latest good exchange, or since the start
  bool stale = false;
  std::uint64_t exchanges_count = 0;
  std::uint64_t failures_count = 0;
  std::uint64_t stale_count = 0;
};

class IoManager {
 public:
  struct Slot {
    DriverConfig config;
    std::unique_ptr<IoDriver> driver;
  };

  /// Inputs are zero until a driver brings some.
  IoManager(std::vector<Slot> slots, std::chrono::nanoseconds now);

  [[nodiscard]] std::size_t drivers_count() const noexcept { return drivers_.size(); }
  [[nodiscard]] const DriverConfig& config(std::size_t index) const noexcept {
    return drivers_[index].config;
  }

  /// One exchange of one driver, which may block.
  /// @param clock  asked after the exchange: when the inputs have come
  template <typename Clock>
  void exchange(std::size_t index, OutputGate& gate, Clock&& clock) noexcept {
    std::array<std::byte, inputs_bytes_max> inputs{};
    const std::span<std::byte> section{inputs.data(), drivers_[index].config.inputs.bytes};
    const bool good = drivers_[index].driver->exchange(gate.frame(), gate, section);
    end_exchange(index, good, section, clock());
  }

  /// Copies all inputs, as they are at this moment.
  void latch(std::span<std::byte> inputs) const noexcept;

  /// Marks inputs that have become stale.
  /// @return the first driver whose stale inputs are to stop the PLC
  std::optional<std::size_t> supervise(std::chrono::nanoseconds now) noexcept;
  /// When inputs become stale if nothing comes; the end of time without drivers.
  [[nodiscard]] std::chrono::nanoseconds next_look() const noexcept;

  [[nodiscard]] DriverState state(std::size_t index, std::chrono::nanoseconds now) const noexcept;

 private:
  struct Driver {
    DriverConfig config;
    std::unique_ptr<IoDriver> driver;
    std::chrono::nanoseconds last_good{0};
    std::uint32_t failures_in_row = 0;
    DriverState state;
  };
  void end_exchange(std::size_t index, bool good, std::span<const std::byte> inputs,
                    std::chrono::nanoseconds now) noexcept;
  void set_stale(Driver& driver, bool stale) noexcept;

  mutable InheritingMutex mutex_;
  std::vector<Driver> drivers_;                       ///< all but config and driver guarded by mutex_
  std::array<std::byte, inputs_bytes_max> inputs_{};  ///< guarded by mutex_
};

}  // namespace emulator_models::soft_plc
