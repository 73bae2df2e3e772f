// What cnc-kernel prints while a part program runs: a line for each handshake with the PLC, and the outputs
// that have changed since.
//
//   N40 M6 T5                 FIN after 1.21 s
//                             Y0 on  Y2 off
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "kernel_mocks/function_table.hpp"
#include "kernel_mocks/part_program_runner.hpp"
#include "kernel_mocks/plc_link.hpp"

namespace kernel_mocks {

class ConsoleReport final : public PartProgramObserver {
 public:
  /// @param link  to look at the outputs with; must outlive the report
  explicit ConsoleReport(PlcLink& link) noexcept : link_{link} {}

  void program_begun(TimePoint at) noexcept override { table_.program_begun(at); }
  void given(const Block& block, const FunctionRequest& request, TimePoint at) noexcept override;
  void not_acknowledged(const Block& block, const FunctionRequest& request,
                        const LogicFailure& failure) noexcept override;
  void acknowledged(const Block& block, const FunctionRequest& request,
                    std::chrono::nanoseconds duration) noexcept override;
  void stop_passed(const Block& block) noexcept override;
  void moved(const Block& block, MotionKind kind, std::chrono::nanoseconds duration,
             bool reached) noexcept override;

  [[nodiscard]] std::size_t function_count() const noexcept { return function_count_; }
  [[nodiscard]] std::size_t motion_count() const noexcept { return motion_count_; }

  /// All functions of the run so far.
  [[nodiscard]] const FunctionTable& table() const noexcept { return table_; }

  /// Reads Y0 to Y17 and prints those that changed since the last look; at the first look, those that are on.
  void show_outputs() noexcept;

 private:
  using Outputs = std::array<std::byte, 2>;

  PlcLink& link_;
  FunctionTable table_;
  Outputs outputs_{};
  std::size_t function_count_ = 0;
  std::size_t motion_count_ = 0;
};

}  // namespace kernel_mocks
