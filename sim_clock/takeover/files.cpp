// Real files. What is read and written there is the host's. But a descriptor belongs to a simulated process, which may die; and locks
// that belong to a whole real process, or wait for another one, are refused: all simulated processes are one.

#include <fcntl.h>
#include <unistd.h>

#include <cstdarg>
#include <cstdio>

#include <fmt/format.h>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;
using ltsim::Segments;

namespace {

int note_opened(int descriptor) noexcept {
  return current_task == nullptr ? descriptor : current_task->world->descriptors().opened(descriptor);
}

std::FILE* note_opened(std::FILE* stream) noexcept {
  if (stream != nullptr && current_task != nullptr) note_opened(fileno(stream));
  return stream;
}

bool makes_a_file(int flags) noexcept { return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE; }

void refuse_control(int descriptor, int command) noexcept {
  const bool is_shared_memory = Segments::is_descriptor(descriptor);
  if (!is_shared_memory && command != F_SETLK && command != F_SETLKW && command != F_OFD_SETLKW) return;
  current_task->world->unsupported(
      fmt::format("{} called fcntl {}, which ltsim does not simulate", current_task->name,
                  is_shared_memory ? "for a shared memory object" : "for a lock that is not F_OFD_SETLK"));
}

}  // namespace

// The mode is there only if a file may be made; code with -D_FILE_OFFSET_BITS=64 calls the names with 64.
#define LTSIM_OPEN(function, parameters, arguments)     \
  extern "C" int function parameters {                  \
    mode_t mode = 0;                                    \
    if (makes_a_file(flags)) {                          \
      va_list list;                                     \
      va_start(list, flags);                            \
      mode = va_arg(list, mode_t);                      \
      va_end(list);                                     \
    }                                                   \
    return note_opened(LTSIM_NEXT(function) arguments); \
  }
LTSIM_OPEN(open, (const char* path, int flags, ...), (path, flags, mode))
LTSIM_OPEN(open64, (const char* path, int flags, ...), (path, flags, mode))
LTSIM_OPEN(openat, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))
LTSIM_OPEN(openat64, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))

extern "C" int creat(const char* path, mode_t mode) { return note_opened(LTSIM_NEXT(creat)(path, mode)); }
extern "C" int creat64(const char* path, mode_t mode) { return note_opened(LTSIM_NEXT(creat64)(path, mode)); }

extern "C" std::FILE* fopen(const char* path, const char* mode) {
  return note_opened(LTSIM_NEXT(fopen)(path, mode));
}
extern "C" std::FILE* fopen64(const char* path, const char* mode) {
  return note_opened(LTSIM_NEXT(fopen64)(path, mode));
}

extern "C" int fclose(std::FILE* stream) {
  if (current_task != nullptr) current_task->world->descriptors().closed(fileno(stream));
  return LTSIM_NEXT(fclose)(stream);
}

extern "C" int dup(int descriptor) noexcept {
  if (current_task != nullptr && Segments::is_descriptor(descriptor))
    current_task->world->unsupported("dup of a shared memory object's descriptor");
  return note_opened(LTSIM_NEXT(dup)(descriptor));
}

#define LTSIM_FCNTL(function)                                                                \
  extern "C" int function(int descriptor, int command, ...) {                                \
    va_list list;                                                                            \
    va_start(list, command);                                                                 \
    void* const argument = va_arg(list, void*);                                              \
    va_end(list);                                                                            \
    if (current_task == nullptr) return LTSIM_NEXT(function)(descriptor, command, argument); \
    refuse_control(descriptor, command);                                                     \
    const int result = LTSIM_NEXT(function)(descriptor, command, argument);                  \
    return command == F_DUPFD || command == F_DUPFD_CLOEXEC ? note_opened(result) : result;  \
  }
LTSIM_FCNTL(fcntl)
LTSIM_FCNTL(fcntl64)
