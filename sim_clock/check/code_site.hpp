// Places in the code of the program, as numbers that are the same in every process that runs it.
#pragma once

#include <cstdint>

#include "sim_clock/world/program_image.hpp"

namespace ltsim {

/// @param return_address  of a call made by the code
/// @return  bytes from the image's begin; 0 for code of a shared library, whose place differs from run to run
inline std::uint32_t code_site(const void* return_address) noexcept {
  return ProgramImage::site_of(return_address);
}

}  // namespace ltsim
