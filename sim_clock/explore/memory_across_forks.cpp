#include "sim_clock/explore/memory_across_forks.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <system_error>

namespace ltsim {

void* new_shared_memory(std::size_t bytes) {
  void* const memory =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) throw std::system_error{errno, std::generic_category(), "memory that is shared"};
  return memory;
}

void delete_shared_memory(void* memory, std::size_t bytes) noexcept { munmap(memory, bytes); }

}  // namespace ltsim
