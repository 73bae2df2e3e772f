// How a sem_t in the memory of the code under test leads to our state of it.
//
// Its first bytes hold the number of the world's execution and the object's index. A handle of an
// earlier execution, which a global may have kept, is recognised by its number.
#pragma once

#include <cstdint>

namespace ltsim {

struct Handle {
  std::uint64_t execution = 0;  ///< World::execution_number() when it was made; never 0 for a live one
  std::uint32_t index = 0;
};

}  // namespace ltsim
