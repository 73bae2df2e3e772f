// What is wrong with an instruction-list source, and where.
//
// Every message names what was found and the way out: the reader has the program before him, not the standard.
#pragma once

#include <cstdint>
#include <string>

namespace emulator_models::soft_plc {

/// Both count from 1; a column is a byte of its line, a tabulator one column.
struct SourcePlace {
  std::uint32_t line = 1;
  std::uint32_t column = 1;

  friend bool operator==(const SourcePlace&, const SourcePlace&) = default;
};

struct IlError {
  SourcePlace place;
  std::string message;

  friend bool operator==(const IlError&, const IlError&) = default;
};

/// "12:5: CR is INT, AND takes BOOL or a bit string"
[[nodiscard]] inline std::string to_string(const IlError& error) {
  return std::to_string(error.place.line) + ':' + std::to_string(error.place.column) + ": " + error.message;
}

}  // namespace emulator_models::soft_plc
