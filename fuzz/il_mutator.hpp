// Makes new instruction-list sources of a given one: whole lines change their places, come twice, go away or come new,
// and words of a line are replaced by others of the language, of the same source, or of another type.
//
// Bytes changed at random make sources that the lexer refuses; these get beyond it.
#pragma once

#include <cstddef>
#include <span>

#include "sim_clock/scenario/fuzz_target.hpp"

namespace fuzz {

/// As ltsim::InputFormat::mutate.
std::size_t mutate_instruction_list(std::span<std::byte> data, std::size_t size, unsigned seed,
                                    ltsim::PlainMutator plain);

}  // namespace fuzz
