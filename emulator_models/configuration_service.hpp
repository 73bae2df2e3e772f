// The PLC's end of a transfer (configuration_frames.hpp): each request answered, on the thread of whoever brings it.
//
// The reason of a refused commit stays until the next commit, so that it can be fetched in parts: whole up to
// reason_bytes_max, and with a mark where it was cut.
// Any thread. A commit takes as long as the new configuration takes to be read and its programs to be compiled.
#pragma once

#include <mutex>
#include <string>
#include <string_view>

#include "emulator_models/configuration_frames.hpp"
#include "emulator_models/soft_plc/configuration_transfer.hpp"

namespace emulator_models {

class ConfigurationService {
 public:
  static constexpr std::size_t reason_bytes_max = 4096;
  static constexpr std::string_view cut_mark = " [cut]";

  /// @param reload  takes the text of a transfer that is whole and right
  explicit ConfigurationService(soft_plc::ConfigurationTransfer::Reload reload)
      : transfer_{std::move(reload)} {}

  [[nodiscard]] TransferAnswer answer(const TransferRequest& request);

 private:
  [[nodiscard]] tl::expected<void, std::string> serve(const TransferRequest& request);

  soft_plc::ConfigurationTransfer transfer_;
  std::mutex mutex_;
  std::uint32_t refused_sum_ = 0;  ///< guarded by mutex_, as what follows
  std::string reason_;             ///< of the latest commit, refused_sum_; empty: it was taken
};

}  // namespace emulator_models
