#include "sim_clock/explore/worker_progress.hpp"

#include <sys/mman.h>

#include <cerrno>
#include <new>
#include <system_error>

namespace ltsim {

SharedProgress::SharedProgress(unsigned workers_count, std::uint64_t execution_last)
    : bytes_(sizeof(ExplorationBounds) + workers_count * sizeof(WorkerProgress)) {
  void* const memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw std::system_error{errno, std::generic_category(), "memory shared with workers"};
  // Fresh pages hold zeros: that is a worker that has done nothing. Writing them here would only make all of
  // them resident.
  bounds_ = static_cast<ExplorationBounds*>(memory);
  bounds_->execution_last.store(execution_last);
  workers_ = reinterpret_cast<WorkerProgress*>(bounds_ + 1);
}

SharedProgress::~SharedProgress() { munmap(bounds_, bytes_); }

}  // namespace ltsim
