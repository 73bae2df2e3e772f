// Blocks of a whole program's heap that were not freed and whose address nobody has any more.
#pragma once

#include <cstddef>
#include <vector>

namespace ltsim {

class World;

/// Looks for words that are an address in a block, and from the blocks that are found so for further ones: in the program's variables
/// and those of its libraries, in the stacks and thread-locals of tasks that have not ended. What merely looks like an address counts
/// as one, so that some leaks are not seen, and what is reported is one.
/// @param stack  of the running task: only what lies above counts
/// @return  indices into ProgramHeap::blocks(), in that order
[[nodiscard]] std::vector<std::size_t> lost_blocks(World& world, const void* stack);

}  // namespace ltsim
