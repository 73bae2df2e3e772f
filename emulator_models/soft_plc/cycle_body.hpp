// What a soft PLC needs of the program of one cycle: a process image of its own, and a way to run it slice by slice.
//
// The PLC writes the image between the calls of the body, on the same thread: inputs at the start of a scan, words
// received from other cycles, writes of field devices. So a body sees inputs that do not change within a scan.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "emulator_models/soft_plc/il_error.hpp"
#include "emulator_models/soft_plc/scan_program.hpp"

namespace emulator_models::soft_plc {

/// Longest image, in bytes: 2048 terminals each way, and the data registers of an FX PLC.
inline constexpr std::size_t inputs_bytes_max = 256;
inline constexpr std::size_t outputs_bytes_max = 256;
inline constexpr std::size_t memory_bytes_max = 16'384;

/// A piece of an area, in bytes.
struct Section {
  std::size_t first = 0;
  std::size_t bytes = 0;

  [[nodiscard]] constexpr std::size_t end() const noexcept { return first + bytes; }
  [[nodiscard]] constexpr bool fits(std::size_t area_bytes) const noexcept {
    return bytes <= area_bytes && first <= area_bytes - bytes;
  }
  [[nodiscard]] constexpr bool overlaps(const Section& other) const noexcept {
    return bytes > 0 && other.bytes > 0 && first < other.end() && other.first < end();
  }
  friend bool operator==(const Section&, const Section&) = default;
};

/// %I, %Q and %M of one cycle; each at most as long as the bounds above.
struct CycleImage {
  std::span<std::byte> inputs;
  std::span<std::byte> outputs;
  std::span<std::byte> memory;
};

class CycleBody {
 public:
  virtual ~CycleBody() = default;

  /// The same spans as long as the body lives.
  [[nodiscard]] virtual CycleImage image() noexcept = 0;
  /// One bit for each output bit that the body writes, as long as the output image. No other cycle writes them.
  [[nodiscard]] virtual std::span<const std::byte> output_mask() const noexcept = 0;
  virtual void start(StartKind kind) noexcept = 0;
  /// As ScanProgram::execute.
  virtual Progress execute(const ScanStep& step) noexcept = 0;
  /// @return where in its source the program has failed, when execute() has just said so; none of a body without source
  [[nodiscard]] virtual std::optional<SourcePlace> failed_at() const noexcept { return std::nullopt; }
  /// The scan under way ends here: the next execute begins at the first instruction.
  virtual void give_up_scan() noexcept = 0;

 protected:
  CycleBody() = default;
  CycleBody(const CycleBody&) = default;
  CycleBody& operator=(const CycleBody&) = default;
};

}  // namespace emulator_models::soft_plc
