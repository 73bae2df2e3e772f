// What a thread can be asked for and told that changes nothing in the simulated world: its name, its stack, the processors that it
// may run on.

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "sim_clock/takeover/next.hpp"
#include "sim_clock/world/world.hpp"

using ltsim::current_task;

namespace {

using ltsim::Task;

/// As many as sysconf(3) says.
constexpr unsigned processors = 2;
constexpr std::uint64_t all_processors = (std::uint64_t{1} << processors) - 1;

Task* find(pthread_t thread) noexcept { return current_task->world->threads().find(thread); }

/// The calls with a process id mean the calling thread with 0; others are not simulated.
Task* task_of_process_id(pid_t id) noexcept { return id == 0 ? current_task : nullptr; }

int set_processors(Task* task, std::size_t bytes, const cpu_set_t* set) noexcept {
  if (task == nullptr) return ESRCH;
  std::uint64_t wanted = 0;
  std::memcpy(&wanted, set, std::min(bytes, sizeof wanted));
  wanted &= all_processors;
  if (wanted == 0) return EINVAL;
  task->traits.processors = wanted;
  return 0;
}

int get_processors(const Task* task, std::size_t bytes, cpu_set_t* set) noexcept {
  if (task == nullptr) return ESRCH;
  if (bytes < sizeof(std::uint64_t)) return EINVAL;
  std::memset(set, 0, bytes);
  const std::uint64_t all = task->traits.processors == 0 ? all_processors : task->traits.processors;
  std::memcpy(set, &all, sizeof all);
  return 0;
}

int as_system_call(int error) noexcept {
  if (error == 0) return 0;
  errno = error;
  return -1;
}

}  // namespace

extern "C" int pthread_setname_np(pthread_t thread, const char* name) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_setname_np)(thread, name);
  Task* const task = find(thread);
  if (task == nullptr) return ESRCH;
  const std::string_view wanted{name};
  if (wanted.size() >= task->traits.name.size()) return ERANGE;
  task->traits.name = {};
  std::copy(wanted.begin(), wanted.end(), task->traits.name.begin());
  return 0;
}

extern "C" int pthread_getname_np(pthread_t thread, char* into, std::size_t bytes) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_getname_np)(thread, into, bytes);
  const Task* const task = find(thread);
  if (task == nullptr) return ESRCH;
  std::string_view name{task->traits.name.data()};
  if (name.empty()) name = std::string_view{current_task->world->process_name(task->process)};
  name = name.substr(0, task->traits.name.size() - 1);
  if (name.size() >= bytes) return ERANGE;
  std::copy(name.begin(), name.end(), into);
  into[name.size()] = '\0';
  return 0;
}

extern "C" int pthread_getattr_np(pthread_t thread, pthread_attr_t* attributes) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_getattr_np)(thread, attributes);
  const Task* const task = find(thread);
  if (task == nullptr) return ESRCH;
  pthread_attr_init(attributes);
  constexpr std::size_t bytes = ltsim::TaskStorage::stack_bytes;
  pthread_attr_setstack(attributes, static_cast<char*>(task->storage->stack_top()) - bytes, bytes);
  pthread_attr_setdetachstate(attributes, task->detached ? PTHREAD_CREATE_DETACHED : PTHREAD_CREATE_JOINABLE);
  return 0;
}

extern "C" int pthread_getcpuclockid(pthread_t thread, clockid_t* clock) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_getcpuclockid)(thread, clock);
  if (find(thread) == nullptr) return ESRCH;
  *clock = CLOCK_THREAD_CPUTIME_ID;  // in the simulated world all clocks show the time that has passed
  return 0;
}

extern "C" int pthread_setaffinity_np(pthread_t thread, std::size_t bytes, const cpu_set_t* set) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_setaffinity_np)(thread, bytes, set);
  return set_processors(find(thread), bytes, set);
}

extern "C" int pthread_getaffinity_np(pthread_t thread, std::size_t bytes, cpu_set_t* set) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(pthread_getaffinity_np)(thread, bytes, set);
  return get_processors(find(thread), bytes, set);
}

extern "C" int sched_setaffinity(pid_t id, std::size_t bytes, const cpu_set_t* set) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_setaffinity)(id, bytes, set);
  return as_system_call(set_processors(task_of_process_id(id), bytes, set));
}

extern "C" int sched_getaffinity(pid_t id, std::size_t bytes, cpu_set_t* set) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_getaffinity)(id, bytes, set);
  return as_system_call(get_processors(task_of_process_id(id), bytes, set));
}

extern "C" int sched_getcpu() noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(sched_getcpu)();
  const std::uint64_t may = current_task->traits.processors;
  return may == 0 ? 0 : __builtin_ctzll(may);
}

extern "C" int getcpu(unsigned* processor, unsigned* node) noexcept {
  if (current_task == nullptr) return LTSIM_NEXT(getcpu)(processor, node);
  if (processor != nullptr) *processor = static_cast<unsigned>(sched_getcpu());
  if (node != nullptr) *node = 0;
  return 0;
}

// pthread_atfork(3). Nobody forks in the simulated world, and the simulator, which does, must not run handlers of the code under test.
extern "C" int __register_atfork(void (*prepare)(), void (*parent)(), void (*child)(), void* dso) noexcept {
  if (current_task != nullptr) return 0;
  using Function = int(void (*)(), void (*)(), void (*)(), void*);
  static auto* const next = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "__register_atfork"));
  return next(prepare, parent, child, dso);
}
