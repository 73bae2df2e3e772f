// Names of the program's variables, from the symbol tables of its images' files; read when a text is written, never in the hot
// path.
#pragma once

#include <cstdint>
#include <string>

namespace ltsim {

struct ProgramSymbol {
  std::string name;          ///< one word, as the source has it: "ledger::total", "next()::count"
  std::uint32_t offset = 0;  ///< among the variables of all images
  std::uint32_t bytes = 0;
};

/// @param offset  of a byte, among the variables of all images
/// @return        the variable that it lies in; without a symbol table, or between variables, one called "variables" that is all of
///                the image's
[[nodiscard]] const ProgramSymbol& symbol_at(std::uint32_t offset);

/// Reads the tables of all images now: processes that are forked from here on need not.
void read_symbols();

}  // namespace ltsim
