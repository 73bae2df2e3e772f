// Where in the sources a place of the program's code comes from, read from the program's own debug
// information when a message is written; never in the hot path.
//
// What a reader wants to see is the line of the code under test, not one of std::atomic or Boost that was
// inlined there: of the functions inlined at the place the innermost one counts that is not in a system or
// Boost header. Without debug information (ltsim_instrument() asks for line tables) a place has no name.
#pragma once

#include <cstdint>
#include <string>

namespace ltsim {

/// @param site  as in Operation: a return address, counted from the program's begin
/// @return      "protocol/x.cpp:40", relative to the folder that holds both the source and the folder it was
///              compiled in; empty if it is not known. The same in every process that runs this program.
[[nodiscard]] const std::string& source_location(std::uint32_t site);

}  // namespace ltsim
