// Where in the sources a place of the program's code comes from, read from the program's own debug
// information when a message is written; never in the hot path.
//
// What a reader wants to see is the line of the code under test, not one of std::atomic or Boost that was
// inlined there: of the functions inlined at the place the innermost one counts that is not in a system or
// Boost header. Without debug information (ltsim_instrument() asks for line tables) a place has no name.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace ltsim {

/// @param site  as in Operation: a return address, counted from the program's begin
/// @return      "protocol/x.cpp:40", relative to the folder that holds both the source and the folder it was
///              compiled in; empty if it is not known. The same in every process that runs this program.
[[nodiscard]] const std::string& source_location(std::uint32_t site);

/// Those that were asked for so far, in the order of that. A process that looks them up as well spares those that it forks the work.
[[nodiscard]] std::span<const std::uint32_t> sites_looked_up() noexcept;

}  // namespace ltsim
