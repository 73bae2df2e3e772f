// Why a configuration file is refused, and where.
#pragma once

#include <cstdint>
#include <string>

namespace kernel_mocks {

struct ConfigError {
  /// From 1; 0 when it is not a place's.
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::string reason;
};

/// "line 4, column 8: ..."
[[nodiscard]] std::string to_string(const ConfigError& error);

}  // namespace kernel_mocks
