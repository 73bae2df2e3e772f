// A simulated thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim_clock/clock/virtual_clock.hpp"
#include "sim_clock/world/context.hpp"
#include "sim_clock/world/kept_registers.hpp"
#include "sim_clock/world/operation.hpp"
#include "sim_clock/world/task_storage.hpp"

namespace ltsim {

class World;

using ProcessId = std::uint8_t;

/// Most processes one world can hold.
inline constexpr std::size_t processes_max = 8;

/// What a blocked task waits for: a mutex, condition or futex word by its address, a semaphore by its number, a task to
/// join by its number. The highest bits tell the kinds apart.
using WaitKey = std::uint64_t;

struct Task {
  enum class State : std::uint8_t {
    runnable,
    blocked,
    stalled,  ///< gets no processor for a while
    finished,
    killed,  ///< with its process
  };

  World* world = nullptr;
  TaskId id = 0;
  ProcessId process = 0;
  State state = State::finished;
  bool timed_out = false;  ///< the last block() ended by its deadline
  bool detached = false;
  bool joined = false;
  WaitKey wait_key = 0;             ///< while blocked
  std::uint64_t blocked_since = 0;  ///< while blocked: orders the waiters of one key
  Operation looked_at;              ///< what the task looks at again and again, if it polls
  std::uint32_t looks_count = 0;    ///< how often in a row it has looked at that, other looks between
  std::uint32_t steps_since_look = 0;
  bool update_failed = false;         ///< its last compare-and-exchange found another value
  std::optional<Operation> polls;     ///< in the fair tail: what it looks at
  std::optional<Operation> repeats;   ///< in the fair tail: what it changes
  SimTime deadline = SimTime::max();  ///< while blocked
  bool deadline_on_wall_clock = false;
  int priority = 0;               ///< of SCHED_FIFO and SCHED_RR, 1 to 99; 0: none
  int effective_priority = 0;     ///< with what is lent by those who wait for its locks
  bool time_sharing = false;      ///< SCHED_RR
  TaskId lends_to = 0;            ///< while blocked: the owner that has this task's priority; or no_task
  std::uint64_t ready_since = 0;  ///< while runnable: orders those of one priority
  std::string name;               ///< "process/task"

  std::function<void()> body;
  void* argument = nullptr;  ///< of a pthread start routine
  void* result = nullptr;    ///< what it returned

  struct ThreadLocalDestructor {
    void (*destroy)(void*);
    void* object;
  };
  std::vector<ThreadLocalDestructor> thread_local_destructors;
  const void* body_frame =
      nullptr;  ///< while its body runs: the frame that called it; there pthread_exit() stops unwinding
  std::vector<void*>
      cleanup_buffers;  ///< __pthread_unwind_buf_t of pthread_cleanup_push(3) in C, the innermost last

  /// What a thread can be asked for and nothing else depends on.
  struct Traits {
    std::array<char, 16> name{};   ///< pthread_setname_np(3); empty: its process's
    int cancel_state = 0;          ///< PTHREAD_CANCEL_ENABLE
    int cancel_type = 0;           ///< PTHREAD_CANCEL_DEFERRED
    std::uint64_t processors = 0;  ///< on which it may run, a bit each; 0: on all
  };
  Traits traits;

  Context context;
  /// Where states are told apart, while it stands still: where the code under test, or what does its call, has come to a point or
  /// has blocked.
  KeptRegisters stands_at;
  bool is_held_up_at_point = false;  ///< it stands at a point, and is not yet asked who goes on from there
  std::unique_ptr<TaskStorage> storage;
};

/// The task whose code runs on this thread; null outside a simulated task and inside a GhostScope. It lies in
/// the task's own thread-local storage, so a switch changes it at no cost.
extern constinit thread_local Task* current_task [[gnu::tls_model("initial-exec")]];

/// While it lives, code of the current task is not part of the simulated world: no scheduling points, and
/// system calls are the real ones. For checks and for text, never for code under test.
class GhostScope {
 public:
  GhostScope() noexcept : task_(current_task) { current_task = nullptr; }
  ~GhostScope() { current_task = task_; }
  GhostScope(const GhostScope&) = delete;
  GhostScope& operator=(const GhostScope&) = delete;

 private:
  Task* task_;
};

}  // namespace ltsim
