// How an object that the code under test holds in its own memory (a sem_t) leads to our
// state of it.
//
// The first bytes of a sem_t hold the number of the world's execution and the object's index. A handle of an
// earlier execution, which a global may have kept, is recognised by its number.
#pragma once

#include <cstdint>

namespace ltsim {

struct Handle {
  std::uint64_t execution = 0;  ///< World::execution_number() when it was made; never 0 for a live one
  std::uint32_t index = 0;
};

}  // namespace ltsim
