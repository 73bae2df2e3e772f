// Runs a compiled program, one scan at a time, over process images that the caller owns: at once, or in slices between
// which the caller can look at the clock.
//
// Invariants
//   I1  inputs are never written; within a scan all function blocks see one `now`, in however many slices it is run.
//   I2  a scan ends: after at most `budget` instructions and one straight piece more, a fault stops it. A slice
//       ends, likewise, at a jump.
//   I3  two machines with one program, equal images and equal times do the same.
// After a fault, variables and images hold what was written before it; whether the PLC goes on is the caller's
// rule. No allocation after construction; no lock: one machine, one thread at a time.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_operations.hpp"
#include "emulator_models/soft_plc/il_program.hpp"

namespace emulator_models::soft_plc {

/// %I, %Q and %M; each at least as long as the program's image_bytes_needed, of any alignment.
struct ProcessImage {
  std::span<const std::byte> inputs;
  std::span<std::byte> outputs;
  std::span<std::byte> memory;
};

enum class SliceEnd : std::uint8_t {
  scan,    ///< the program has come to its end
  length,  ///< it goes on in the next slice
};

struct RunTimeFault {
  FaultKind kind = FaultKind::division_by_zero;
  SourcePlace place;

  friend bool operator==(const RunTimeFault&, const RunTimeFault&) = default;
};

/// "12:5: division by zero"
[[nodiscard]] std::string to_string(const RunTimeFault& fault);

class IlMachine {
 public:
  enum class Start : std::uint8_t { cold, warm };
  /// 20 times what the longest program without a jump needs; 3 ms of boolean rungs, 12 ms of arithmetic (il_bench).
  static constexpr std::uint64_t default_budget = 20 * code_length_max;

  /// Cold at first.
  /// @param program  as compile() made it; must outlive the machine
  explicit IlMachine(const IlProgram& program);

  /// Cold: all variables get their initial values, as does the image in the next scan. Warm: RETAIN variables
  /// keep their values and the image is left alone.
  void start(Start kind) noexcept;

  /// One run of the program from its first instruction to its end or RET. A scan that slices have begun is given up.
  /// @param now     of this scan; since any fixed moment, never decreasing
  /// @param budget  instructions allowed; looked at on jumps and at the end
  /// @return        instructions executed; or the fault and where it struck
  [[nodiscard]] tl::expected<std::uint64_t, RunTimeFault> run_scan(
      const ProcessImage& image, std::chrono::nanoseconds now,
      std::uint64_t budget = default_budget) noexcept;

  /// One bounded piece of a scan: from the first instruction on, or from where the slice before has ended.
  /// @param now           of this scan; looked at in its first slice only
  /// @param slice_length  instructions after which the next jump ends the slice
  /// @param budget        instructions allowed in the whole scan
  /// @return              how the slice ended; after a fault the next slice begins a scan
  [[nodiscard]] tl::expected<SliceEnd, RunTimeFault> run_slice(
      const ProcessImage& image, std::chrono::nanoseconds now, std::uint64_t slice_length,
      std::uint64_t budget = default_budget) noexcept;

  /// Gives up what is left of a scan: the next slice begins at the first instruction.
  void abandon_scan() noexcept { suspended_.reset(); }

  /// A variable of the program as the accumulator would hold it (il_types.hpp). One that lies AT an address is
  /// part of the image and not seen here.
  /// @param upper_name  in capitals
  [[nodiscard]] std::optional<std::uint64_t> value(std::string_view upper_name) const noexcept;
  /// @param bits  the bytes of the type's width count
  /// @return      whether there is such a variable
  bool set_value(std::string_view upper_name, std::uint64_t bits) noexcept;

 private:
  /// Where a scan stands between two slices.
  struct Progress {
    std::uint32_t next = 0;
    std::uint64_t executed = 0;
    std::uint64_t acc = 0;
    std::array<std::uint64_t, nesting_max> slots{};
    std::chrono::nanoseconds now{0};
  };

  /// @param limit     instructions of the scan after which the next jump ends the slice, at most budget
  /// @param progress  where to begin; where it stands, when the slice ends before the scan; else `executed` counts
  [[nodiscard]] tl::expected<SliceEnd, RunTimeFault> run(const ProcessImage& image, Progress& progress,
                                                         std::uint64_t limit, std::uint64_t budget) noexcept;
  [[nodiscard]] bool image_suffices(const ProcessImage& image) const noexcept;
  void initialize(const ProcessImage& image) noexcept;

  const IlProgram& program_;
  std::vector<std::byte> variables_;
  bool image_is_to_be_initialized_ = true;
  std::optional<Progress> suspended_;
};

}  // namespace emulator_models::soft_plc
