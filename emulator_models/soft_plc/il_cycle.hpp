// An instruction-list program as the body of a cycle, with its process image.
//
// A slice ends at the first jump after slice_instructions: the watchdog, and cycles of other priorities, get a look
// in between. So an endless loop is ended by the watchdog, by time; scan_instructions_max is only the bound of a scan
// whose watchdog has been given hours.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "emulator_models/soft_plc/cycle_body.hpp"
#include "emulator_models/soft_plc/il_machine.hpp"
#include "emulator_models/soft_plc/inheriting_mutex.hpp"

namespace emulator_models::soft_plc {

/// Whether an instruction writes its operand, for all that has to know who writes what.
[[nodiscard]] bool writes_operand(const Instruction& instruction) noexcept;
/// The bytes that the operand of an instruction covers.
[[nodiscard]] Section operand_section(const Instruction& instruction) noexcept;

class IlCycle final : public CycleBody {
 public:
  /// 6 us of boolean rungs, 20 us of arithmetic: what a cycle of higher priority waits for at most.
  static constexpr std::uint64_t slice_instructions = 2'048;
  static constexpr std::uint64_t scan_instructions_max = 1'000'000'000;

  /// @param program  whose image needs do not exceed the bounds of cycle_body.hpp
  explicit IlCycle(IlProgram program);

  CycleImage image() noexcept override { return {inputs_, outputs_, memory_}; }
  std::span<const std::byte> output_mask() const noexcept override { return output_mask_; }
  void start(StartKind kind) noexcept override;
  Progress execute(const ScanStep& step) noexcept override;
  std::optional<SourcePlace> failed_at() const noexcept override;
  void give_up_scan() noexcept override { machine_.abandon_scan(); }

  /// From any thread.
  /// @return the latest run-time fault since the last start
  [[nodiscard]] std::optional<RunTimeFault> run_time_fault() const noexcept;

 private:
  IlProgram program_;
  IlMachine machine_;
  std::vector<std::byte> inputs_;
  std::vector<std::byte> outputs_;
  std::vector<std::byte> memory_;
  std::vector<std::byte> output_mask_;
  mutable InheritingMutex mutex_;
  std::optional<RunTimeFault> fault_;  ///< guarded by mutex_
};

}  // namespace emulator_models::soft_plc
