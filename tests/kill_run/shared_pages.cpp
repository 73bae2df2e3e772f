#include "tests/kill_run/shared_pages.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <system_error>

namespace kill_run {

SharedPages::SharedPages(std::size_t size_bytes)
    : size_bytes_(size_bytes),
      address_(::mmap(nullptr, size_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE,
                      -1, 0)) {
  if (address_ == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap");
}

SharedPages::~SharedPages() { ::munmap(address_, size_bytes_); }

}  // namespace kill_run
