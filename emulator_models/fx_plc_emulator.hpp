// An FX PLC as its programming port shows it: the memory of one model, and the rules what is answered,
// refused or met with silence (README.md has the table, with the reasons).
//
// One mutex guards the memory. Each request, and each scan, holds it from beginning to end: a request sees
// the memory between two scans, and a write of many bytes takes effect as one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <utility>

#include "emulator_models/device_memory.hpp"
#include "emulator_models/i_plc_emulator.hpp"
#include "emulator_models/special_devices.hpp"
#include "protocol/fx/address_map.hpp"
#include "protocol/fx/frame.hpp"

namespace emulator_models {

class FxPlcEmulator final : public IPlcEmulator {
 public:
  /// Switched on, in STOP; the first scan brings it into RUN (fx_plc.hpp).
  explicit FxPlcEmulator(protocol::fx::Model model);

  /// @return ACK to ENQ; data, ACK or NAK to a frame; nothing to anything else
  [[nodiscard]] protocol::fx::FrameBytes process(std::span<const std::byte> request) noexcept override;

  /// The memory, locked as long as this lives: everybody else waits. Who has it must not call another member of
  /// the same emulator but the process() below.
  class LockedMemory {
   public:
    [[nodiscard]] DeviceMemory& operator*() const noexcept { return memory_; }
    [[nodiscard]] DeviceMemory* operator->() const noexcept { return &memory_; }

   private:
    friend FxPlcEmulator;
    LockedMemory(std::mutex& mutex, DeviceMemory& memory) : lock_{mutex}, memory_{memory} {}

    std::unique_lock<std::mutex> lock_;
    DeviceMemory& memory_;
  };
  [[nodiscard]] LockedMemory lock() { return {mutex_, memory_}; }
  /// process() for who has the memory locked.
  [[nodiscard]] protocol::fx::FrameBytes process(std::span<const std::byte> request,
                                                 const LockedMemory& memory) noexcept;

  /// Calls `action` with the memory, locked: all that it reads belongs together.
  /// @param action  callable with a DeviceMemory&; must not call this object again
  template <class Action>
  decltype(auto) with_memory(Action&& action) {
    const std::lock_guard lock{mutex_};
    return std::forward<Action>(action)(memory_);
  }
  /// A copy of the memory, made between two scans.
  [[nodiscard]] DeviceMemory snapshot() const;

  /// @param device  a bit device that the model has
  [[nodiscard]] bool read_bit(protocol::fx::Device device) const noexcept;
  /// @param device  a word device that the model has; of a 32-bit counter the low word
  [[nodiscard]] std::uint16_t read_word(protocol::fx::Device device) const noexcept;

 private:
  [[nodiscard]] protocol::fx::FrameBytes process_locked(std::span<const std::byte> request) noexcept;
  [[nodiscard]] protocol::fx::FrameBytes execute(const protocol::fx::Request& request) noexcept;
  [[nodiscard]] protocol::fx::FrameBytes read(const protocol::fx::Request& request) noexcept;
  [[nodiscard]] protocol::fx::FrameBytes write(const protocol::fx::Request& request) noexcept;
  [[nodiscard]] protocol::fx::FrameBytes force(const protocol::fx::Request& request) noexcept;
  [[nodiscard]] protocol::fx::FrameBytes refuse(PortTrouble trouble) noexcept;

  mutable std::mutex mutex_;
  DeviceMemory memory_;
};

}  // namespace emulator_models
