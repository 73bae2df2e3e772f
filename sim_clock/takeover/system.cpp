// What differs from machine to machine and from run to run, and the raw system calls that libstdc++ makes.

#include <linux/futex.h>
#include <sys/random.h>
#include <sys/syscall.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "sim_clock/explore/random_generator.hpp"
#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

constexpr int processors = 2;

/// What Linux would call the thread's id.
pid_t task_number() noexcept {
  return ltsim::World::first_system_id + 100 * (current_task->process + 1) + current_task->id;
}

/// futex(2) as std::atomic::wait, std::counting_semaphore and the guards of static variables use it.
long futex(std::uint32_t* word, int operation, std::uint32_t value, const timespec* timeout) noexcept {
  ltsim::World& world = *current_task->world;
  const bool shared = (operation & FUTEX_PRIVATE_FLAG) == 0;
  switch (operation & ~(FUTEX_PRIVATE_FLAG | FUTEX_CLOCK_REALTIME)) {
    case FUTEX_WAIT:  // the time-out is relative
      return world.mutexes().futex_wait(word, value,
                                        timeout == nullptr
                                            ? ltsim::VirtualClock::never
                                            : world.now() + std::chrono::seconds{timeout->tv_sec} +
                                                  std::chrono::nanoseconds{timeout->tv_nsec},
                                        shared);
    case FUTEX_WAIT_BITSET:  // absolute
      return world.mutexes().futex_wait(
          word, value,
          timeout == nullptr
              ? ltsim::Deadline{ltsim::VirtualClock::never}
              : world.to_deadline((operation & FUTEX_CLOCK_REALTIME) != 0 ? CLOCK_REALTIME : CLOCK_MONOTONIC,
                                  *timeout),
          shared);
    case FUTEX_WAKE:
      return world.mutexes().futex_wake(word, value, shared);
    default:
      world.unsupported(fmt::format("futex(2) with operation {}", operation));
      return -1;
  }
}

}  // namespace

extern "C" pid_t getpid() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(getpid)();
  return current_task->world->system_id(current_task->process);
}

extern "C" pid_t gettid() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(gettid)();
  return task_number();
}

extern "C" long sysconf(int name) noexcept {
  if (current_task != nullptr && (name == _SC_NPROCESSORS_ONLN || name == _SC_NPROCESSORS_CONF))
    return processors;
  return LTSIM_NEXT(sysconf)(name);
}

extern "C" int get_nprocs() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(get_nprocs)();
  return processors;
}

// The same bytes in every execution: chance comes from the strategy alone. A scenario that wants other bytes
// asks World::choose().
extern "C" ssize_t getrandom(void* buffer, std::size_t bytes, unsigned flags) {
  if (current_task == nullptr) return LTSIM_NEXT(getrandom)(buffer, bytes, flags);
  ltsim::RandomGenerator generator{current_task->world->next_random_draw(current_task->process)};
  for (std::size_t i = 0; i < bytes; ++i)
    static_cast<unsigned char*>(buffer)[i] = static_cast<unsigned char>(generator.next());
  return static_cast<ssize_t>(bytes);
}

extern "C" int getentropy(void* buffer, std::size_t bytes) {
  if (current_task == nullptr) return LTSIM_NEXT(getentropy)(buffer, bytes);
  constexpr std::size_t bytes_max = 256;  // getentropy(3)
  if (bytes > bytes_max) {
    errno = EIO;
    return -1;
  }
  getrandom(buffer, bytes, 0);
  return 0;
}

extern "C" void arc4random_buf(void* buffer, std::size_t bytes) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(arc4random_buf)(buffer, bytes);
  getrandom(buffer, bytes, 0);
}

extern "C" std::uint32_t arc4random() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(arc4random)();
  std::uint32_t number = 0;
  getrandom(&number, sizeof number, 0);
  return number;
}

extern "C" std::uint32_t arc4random_uniform(std::uint32_t bound) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(arc4random_uniform)(bound);
  if (bound < 2) return 0;
  return ltsim::RandomGenerator{current_task->world->next_random_draw(current_task->process)}.below(bound);
}

extern "C" long syscall(long number, ...) noexcept {
  va_list list;
  va_start(list, number);
  long arguments[6];
  for (long& argument : arguments) argument = va_arg(list, long);
  va_end(list);
  if (current_task == nullptr) {
    return LTSIM_NEXT(syscall)(number, arguments[0], arguments[1], arguments[2], arguments[3], arguments[4],
                               arguments[5]);
  }
  switch (number) {
    case SYS_futex:
      return futex(reinterpret_cast<std::uint32_t*>(arguments[0]), static_cast<int>(arguments[1]),
                   static_cast<std::uint32_t>(arguments[2]), reinterpret_cast<const timespec*>(arguments[3]));
    case SYS_gettid:
      return task_number();
    default:
      current_task->world->unsupported(fmt::format("syscall(2) with number {}", number));
      return -1;
  }
}
