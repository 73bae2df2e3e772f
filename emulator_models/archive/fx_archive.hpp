// Archive and recorder of one FX PLC, as the command line of plc-emulator asks for them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emulator_models/archive/plc_archive.hpp"
#include "emulator_models/fx_recorder.hpp"

namespace emulator_models::archive {

struct FxArchiveOptions {
  std::string path;                    ///< empty: no archive
  std::vector<std::string> signals{};  ///< bit devices whose changes are recorded: "X0", "Y17", "M100"
  std::int64_t rows_max = 1'000'000;
};

class FxArchive {
 public:
  /// @param power_up             from which the times of the records count
  /// @param power_up_wall_clock  the same moment
  /// @param tell                 called by the archive's thread with the message of an error
  /// @return                     the archive; or what is wrong, and the way out
  [[nodiscard]] static tl::expected<std::unique_ptr<FxArchive>, std::string> open(
      const FxArchiveOptions& options, protocol::fx::Model model, SteadyTime power_up,
      WallTime power_up_wall_clock, std::function<void(const std::string&)> tell) noexcept;

  /// For FxPlc::observe_with.
  [[nodiscard]] FxRecorder& recorder() noexcept { return recorder_; }
  /// After the last scan.
  /// @return how much was stored and lost, in words
  std::string stop(SteadyTime now);

 private:
  FxArchive(const FxRecorderConfig& config, protocol::fx::Model model, SteadyTime power_up)
      : recorder_{config, model, power_up} {}

  FxRecorder recorder_;
  std::unique_ptr<PlcArchive> archive_;
};

}  // namespace emulator_models::archive
