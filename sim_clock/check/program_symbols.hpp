// Names of the program's variables, from the symbol table of the program's own file; read when a text is written, never in the hot
// path.
#pragma once

#include <cstdint>
#include <string>

namespace ltsim {

struct ProgramSymbol {
  std::string name;          ///< one word, as the source has it: "ledger::total", "next()::count"
  std::uint32_t offset = 0;  ///< from the begin of the variables (ProgramImage::variables())
  std::uint32_t bytes = 0;
};

/// @param offset  from the begin of the variables
/// @return        the variable that it lies in; without a symbol table, or between variables, one called "variables" that is all
[[nodiscard]] const ProgramSymbol& symbol_at(std::uint32_t offset);

}  // namespace ltsim
