// Places in the code of the program, as numbers that are the same in every process that runs it.
#pragma once

#include <cstdint>

// Defined by the linker (GNU ld and LLVM's lld): begin of the program's image, end of its code.
extern "C" const char __executable_start;
extern "C" const char etext;

namespace ltsim {

/// @param return_address  of a call made by the code
/// @return  bytes from the image's begin; 0 for code of a shared library, whose place differs from run to run
inline std::uint32_t code_site(const void* return_address) noexcept {
  const auto begin = reinterpret_cast<std::uintptr_t>(&__executable_start);
  const auto site = reinterpret_cast<std::uintptr_t>(return_address) - begin;
  return site < reinterpret_cast<std::uintptr_t>(&etext) - begin ? static_cast<std::uint32_t>(site) : 0;
}

}  // namespace ltsim
