// shm_open(3), and the file calls on what it returns. Other descriptors are real: only those of shared memory
// objects are simulated.
//
// A scenario may destroy objects of the code under test after the run, outside any task. They then close and
// unmap what only existed in the world: that does nothing.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <initializer_list>
#include <string_view>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;
using ltsim::OperationKind;
using ltsim::Segments;

namespace {

/// @param name  called for the name of what is opened or unlinked, or of what the descriptor is of
template <typename Name>
void point(OperationKind kind, const Name& name) noexcept {
  ltsim::Scheduler& scheduler = current_task->world->scheduler();
  scheduler.point({.kind = kind, .name = scheduler.name_for_strategy(name)});
}

/// Whether a granted fault makes the call fail; errno is then one of `errors`.
bool fails(std::initializer_list<int> errors) noexcept {
  const std::size_t variant =
      current_task->world->faults().strike(ltsim::FaultKind::call_failure, errors.size());
  if (variant == 0) return false;
  errno = errors.begin()[variant - 1];
  return true;
}

bool is_simulated(int descriptor) noexcept {
  return current_task != nullptr && Segments::is_descriptor(descriptor);
}

auto name_of(int descriptor) noexcept {
  return [descriptor] { return current_task->world->segments().name_of(descriptor); };
}

auto as_name(const char* name) noexcept {
  return [name] { return std::string_view{name}; };
}

}  // namespace

extern "C" int shm_open(const char* name, int flags, mode_t mode) {
  if (current_task == nullptr)
    return ltsim::World::refuses_real("shm_open") ? -1 : LTSIM_NEXT(shm_open)(name, flags, mode);
  point(OperationKind::shm_open, as_name(name));
  if (fails({EACCES, EMFILE, ENFILE})) return -1;  // shm_open(3)
  return current_task->world->segments().open(name, flags);
}

extern "C" int shm_unlink(const char* name) {
  if (current_task == nullptr) return LTSIM_NEXT(shm_unlink)(name);
  point(OperationKind::shm_unlink, as_name(name));
  return current_task->world->segments().unlink(name);
}

extern "C" int ftruncate(int descriptor, off_t bytes) noexcept {
  if (!is_simulated(descriptor)) return LTSIM_NEXT(ftruncate)(descriptor, bytes);
  point(OperationKind::shm_resize, name_of(descriptor));
  if (fails({EINTR, EFBIG, EIO})) return -1;  // ftruncate(2)
  return current_task->world->segments().resize(descriptor, bytes);
}

extern "C" int fstat(int descriptor, struct stat* into) noexcept {
  if (!is_simulated(descriptor)) return LTSIM_NEXT(fstat)(descriptor, into);
  point(OperationKind::shm_status, name_of(descriptor));
  return current_task->world->segments().status(descriptor, *into);
}

// The names under which code with -D_FILE_OFFSET_BITS=64 calls the same functions; off_t is 64 bits wide
// anyway.
extern "C" int ftruncate64(int descriptor, off64_t bytes) noexcept { return ftruncate(descriptor, bytes); }
extern "C" void* mmap64(void* address, std::size_t bytes, int protection, int flags, int descriptor,
                        off64_t offset) noexcept {
  return mmap(address, bytes, protection, flags, descriptor, offset);
}

extern "C" int fchmod(int descriptor, mode_t mode) noexcept {
  if (!is_simulated(descriptor)) return LTSIM_NEXT(fchmod)(descriptor, mode);
  return 0;  // the simulated world has one user
}

extern "C" void* mmap(void* address, std::size_t bytes, int protection, int flags, int descriptor,
                      off_t offset) noexcept {
  if (!is_simulated(descriptor))
    return LTSIM_NEXT(mmap)(address, bytes, protection, flags, descriptor, offset);
  point(OperationKind::shm_map, name_of(descriptor));
  if (fails({EAGAIN, ENFILE, ENOMEM})) return MAP_FAILED;  // mmap(2)
  return current_task->world->segments().map(bytes, protection, flags, descriptor, offset);
}

extern "C" int munmap(void* address, std::size_t bytes) noexcept {
  if (!Segments::contains(address)) return LTSIM_NEXT(munmap)(address, bytes);
  if (current_task == nullptr) return 0;
  point(OperationKind::shm_unmap, as_name(""));
  return current_task->world->segments().unmap(address, bytes);
}

extern "C" int msync(void* address, std::size_t bytes, int flags) {
  if (current_task == nullptr || !Segments::contains(address))
    return LTSIM_NEXT(msync)(address, bytes, flags);
  return 0;  // there is no file behind it
}

extern "C" int close(int descriptor) {
  if (!Segments::is_descriptor(descriptor)) {
    if (current_task != nullptr) current_task->world->descriptors().closed(descriptor);
    return LTSIM_NEXT(close)(descriptor);
  }
  if (current_task == nullptr) return 0;
  return current_task->world->segments().close(descriptor);
}
