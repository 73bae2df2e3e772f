// One simulated execution: processes, their tasks, the clock, and the kernel objects they share.
//
// A scenario gets a world, sets up its processes and calls run():
//
//     SCENARIO("demo/handoff", "two processes and a semaphore") {
//       world.process("kernel").start("main", [&] { ... });
//       world.process("emulator").start("main", [&] { ... });
//       world.run();
//       world.require(answered, "every request is answered");
//     }
//
// The code in the tasks is ordinary code, compiled with ltsim_instrument(). Nothing of an execution survives
// it; the world itself is pooled. One world exists at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim_clock/check/memory_checks.hpp"
#include "sim_clock/check/outcome.hpp"
#include "sim_clock/check/single_fetch.hpp"
#include "sim_clock/check/written_first.hpp"
#include "sim_clock/clock/deadline.hpp"
#include "sim_clock/world/barriers.hpp"
#include "sim_clock/world/damages.hpp"
#include "sim_clock/world/descriptors.hpp"
#include "sim_clock/world/faults.hpp"
#include "sim_clock/world/memory_model.hpp"
#include "sim_clock/world/mutexes.hpp"
#include "sim_clock/world/object_names.hpp"
#include "sim_clock/world/program_memory.hpp"
#include "sim_clock/world/random_numbers.hpp"
#include "sim_clock/world/rwlocks.hpp"
#include "sim_clock/world/scheduler.hpp"
#include "sim_clock/world/segments.hpp"
#include "sim_clock/world/semaphores.hpp"
#include "sim_clock/world/signals.hpp"
#include "sim_clock/world/spin_locks.hpp"
#include "sim_clock/world/static_guards.hpp"
#include "sim_clock/world/system_v_segments.hpp"
#include "sim_clock/world/system_v_semaphores.hpp"
#include "sim_clock/world/thread_specific.hpp"
#include "sim_clock/world/threads.hpp"
#include "sim_clock/world/weak_memory.hpp"
#include "sim_clock/world/whole_state.hpp"

namespace ltsim {

/// A simulated process: tasks that see shared memory at addresses of their own.
class Process {
 public:
  Process(World& world, ProcessId id, std::string_view name) : world_(world), id_(id), name_(name) {}

  /// Adds a task. It starts to run when the strategy first chooses it; what it does before its first
  /// scheduling point is not visible to anybody.
  /// @param name  unique within the process; shown as "process/name"
  void start(std::string_view name, std::function<void()> body);

  /// Grants crashes: at any scheduling point of the world the process may be killed, as by kill -9.
  /// With `restart_after` all that start() had made before World::run() begins again that much later, as new
  /// tasks: "process@2/name". The bodies are copies made before the first run: what they capture by reference
  /// is not fresh then.
  void may_crash(CrashGrant grant);
  /// Grants stalls: at any scheduling point of the world the process, with all its tasks, may get no processor for 1 ms
  /// to 10 s, up to `times` times in an execution.
  void may_stall(unsigned times);
  /// Which life this is, from 1. Between a crash and the restart already the one to come.
  [[nodiscard]] unsigned incarnation() const noexcept { return incarnation_; }
  /// How often it was killed in this execution.
  [[nodiscard]] unsigned crashes() const noexcept { return crashes_; }
  /// Some task of it has not ended, and it is not dead or waiting to be started again.
  [[nodiscard]] bool is_running() const noexcept;

  /// In this life.
  [[nodiscard]] bool has_made_threads() const noexcept { return threads_created_count_ != 0; }

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] ProcessId id() const noexcept { return id_; }

  // --- for Faults ---

  /// Keeps copies of the bodies of its tasks, which have not run yet.
  void remember_tasks();
  /// It was killed; nothing of it runs any more.
  void died(std::optional<SimTime> restart_after);

 private:
  friend class World;

  struct Start {
    std::string task;  // without the process's name
    std::function<void()> body;
  };

  void reset() noexcept;

  World& world_;
  ProcessId id_;
  std::string name_;
  unsigned threads_created_count_ = 0;  // in this execution and this life, as everything below
  unsigned random_draws_count_ = 0;
  unsigned incarnation_ = 1;
  unsigned crashes_ = 0;
  SimTime begin_{0};           // of this life
  std::vector<Start> starts_;  // only of a process that may start again
};

class World {
 public:
  World();
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // --- for scenarios ---

  /// The process of that name; the first call makes it. At most Segments::processes_max.
  Process& process(std::string_view name);

  /// Grants a fault: it may strike up to `times` times, wherever it can. Not for crashes (Process::may_crash) and
  /// for what damages a segment (grant_in).
  void grant(FaultKind kind, unsigned times);
  /// Grants damage to bytes of a segment: FaultKind::bit_flip, or FaultKind::foreign_write of one byte: zeroes,
  /// ones, or one more than was there. It strikes at accesses to that segment, anywhere in it.
  /// @param segment  name of the segment without '/'; it may be created later
  void grant_in(FaultKind kind, std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                unsigned times);

  /// At set-up: a shared memory object that somebody left there, in a life before.
  /// @param name  as for shm_open(3)
  void leave_segment(std::string_view name, std::span<const std::byte> content) {
    segments_.leave(name, content);
  }
  /// At set-up: a named semaphore that somebody left there.
  /// @param name  as for sem_open(3)
  void leave_semaphore(std::string_view name, unsigned value) { semaphores_.leave(name, value); }

  /// Runs all tasks until they have finished or the execution has failed.
  /// @throw Abandoned  the strategy is not interested in the rest: for who runs the scenario, who must not catch it himself
  void run();
  struct Abandoned {};
  /// Whether the execution has failed already: what a scenario checks after run() means nothing then.
  [[nodiscard]] bool failed() const noexcept { return !scheduler_.outcome().passed(); }

  /// A property of the scenario is broken: ends the execution. Callable from anywhere, tasks included.
  void violated(std::string message) { scheduler_.fail(OutcomeKind::invariant, std::move(message)); }
  /// violated(message) unless `holds`. After a failure it does nothing.
  void require(bool holds, std::string_view message);

  /// Ends the execution here, as it stands: the scenario has seen what it is there for. It has passed.
  void finish() { scheduler_.fail(OutcomeKind::passed, {}); }

  /// A choice of the scenario, made by the strategy and kept in the schedule; 0 by default.
  /// @param what   names the question in the schedule, one word
  /// @param count  number of possibilities, 1 to 256
  /// @return       0 to count - 1
  [[nodiscard]] std::size_t choose(std::string_view what, std::size_t count) {
    return scheduler_.choose(what, count);
  }

  /// Bytes for the scenario to read, the same in each execution, and kept in the schedule; empty by default. What a fuzz
  /// target is run on.
  [[nodiscard]] const std::string& input() const noexcept { return input_; }

  /// Gives bytes of a segment a name of their own for schedules and traces.
  /// @param segment  name of the segment without '/'; it may be created later
  /// @param region   e.g. "segment.request"
  void name_region(std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                   std::string_view region) {
    objects_.name_region(segment, offset, bytes, region);
  }

  /// More tokens than that in a semaphore, once it has been opened or posted, end the execution.
  /// @param semaphore  its name, without '/', or that of the segment that it begins; it is opened later
  /// @param count_max  0 to SEM_VALUE_MAX
  void bound_semaphore(std::string_view semaphore, unsigned count_max) {
    semaphores_.bound(semaphore, count_max);
  }

  /// A task that loads these bytes of a segment twice without a wait, a hand-over or a write of its own to them
  /// between ends the execution: what it checked need not be what it uses. What that means exactly is said in
  /// check/single_fetch.hpp.
  /// @param segment  name of the segment without '/'; it may be created later
  /// @param bytes    1 to 8
  /// @param name     for the message, e.g. "segment.request-length"
  void single_fetch(std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                    std::string_view name) {
    fetches_.declare(segment, offset, bytes, name);
    scheduler_.check_steps();
  }

  /// A task that reads one of these bytes of a segment before somebody has written it ends the execution: whoever made
  /// the segment has not made what is in it. Not for words that are polled while they are still zero.
  /// @param segment  name of the segment without '/'; it may be created later
  /// @param bytes    1 to Segments::segment_bytes_max
  /// @param name     for the message, e.g. "segment.request"
  void written_first(std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                     std::string_view name) {
    written_first_.declare(segment, offset, bytes, name);
    scheduler_.check_steps();
  }

  /// Calls `check` each time that every task waits of its own accord and none is merely held up, before time
  /// moves on. It may call violated().
  void whenever_idle(std::function<void()> check) { scheduler_.add_idle_check(std::move(check)); }

  /// Calls `note` with how much time has just passed each time that it passes although some task could go on: the processor
  /// was slow for it. What a time-out that fires then says of the peer is no fault of the peer's.
  void whenever_held_up(std::function<void(SimTime)> note) { scheduler_.add_held_up_note(std::move(note)); }

  /// Two accesses to a segment that nothing orders, one of them plain and one a write, are a failure of their
  /// own (data-race) in an execution that does not fail otherwise. Not in this one: the scenario is about what
  /// comes of them.
  void allow_data_races() noexcept { checks_.allow_races(); }

  /// Tells the abstract state that the scenario is in, by a number that means the same in each execution: a
  /// strategy that learns goes where new ones are seen. Callable from anywhere, tasks included.
  void abstract_state(std::uint64_t hash) noexcept { checks_.coverage().abstract_state(hash); }

  /// More scheduling points than this are a livelock. Default Scheduler::points_max_default.
  void set_points_max(std::uint64_t points) noexcept { scheduler_.set_points_max(points); }

  /// In this execution nobody is slow of the strategy's will: time passes only when nobody can run.
  void set_steady() noexcept { scheduler_.set_steady(); }

  /// Which processors the simulated machine has in this execution.
  void set_cpu(Cpu cpu) noexcept { scheduler_.set_cpu(cpu); }

  /// Which orders of memory accesses this execution shows. Before the first task is made.
  void set_memory(Memory memory);
  [[nodiscard]] Memory memory() const noexcept { return weak_.on() ? Memory::c11 : Memory::sc; }

  /// What `task` ("process/name") is blocked in, or nothing if it is not blocked. Of a process that was started
  /// again it is the task of its latest life.
  /// @return e.g. "sem_wait handoff"
  [[nodiscard]] std::string blocked_in(std::string_view task) const;

  [[nodiscard]] SimTime now() const noexcept { return scheduler_.clock().now(); }

  struct Exit {
    int status = 0;
    bool is_orderly = true;       ///< by exit(3), not by _exit(2) and its kind: handlers are called
    const void* stack = nullptr;  ///< of the task that exits: what lies below is of no interest to anybody
  };
  /// What exit(3) and its kind come to in a task; without it they are refused. Must end the execution.
  void set_exit(std::function<void(const Exit&)> exit) { exit_ = std::move(exit); }
  /// What the code under test has written on its standard output and for errors: shown with a failure.
  void set_output(std::string text) { output_ = std::move(text); }
  [[nodiscard]] const std::string& output() const noexcept { return output_; }

  /// A remark for the trace. `text()` is only called when somebody reads it.
  template <typename Text>
  void note(Text&& text) {
    if (scheduler_.listener() == nullptr) return;
    const GhostScope ghost;
    scheduler_.listener()->notes(std::forward<Text>(text)());
  }

  // --- for the explorer ---

  /// Forgets the last execution. `listener` may be null. From here to end_execution() the world is the
  /// scenario's.
  void reset(Strategy& strategy, StepListener* listener);
  /// What input() is in the executions from the next one on.
  /// @param records  together they are the input
  void set_input(std::vector<std::string> records);
  [[nodiscard]] const std::vector<std::string>& input_records() const noexcept { return input_records_; }
  /// Which processors the machine has in the executions from the next one on, unless their scenario says
  /// otherwise. Cpu::many at first.
  void set_default_cpu(Cpu cpu) noexcept { default_cpu_ = cpu; }
  /// The same for memory; Memory::sc at first.
  void set_default_memory(Memory memory) noexcept { default_memory_ = memory; }
  /// Which findings are failures in the executions from the next one on. All of them at first.
  void set_findings(Findings findings) noexcept { findings_ = findings; }
  [[nodiscard]] Findings findings() const noexcept { return findings_; }
  /// An execution that has passed up to here still fails if there was a race, or else if a mutex is held.
  void end_execution() noexcept;

  /// Races, memory that changed unseen and coverage: on or off in the executions that begin from now on. Off
  /// is for measuring what they cost.
  void set_checks(bool on) noexcept { checks_.set_on(on); }
  /// What no execution before this one has shown, since Coverage::forget().
  [[nodiscard]] Coverage& coverage() noexcept { return checks_.coverage(); }

  /// Everything besides memory that decides what can follow; stacks are among it.
  void add_state(StateHash& hash) const noexcept;

  // --- for the takeover functions ---

  /// Outside any task, but while a scenario sets up or checks: a real kernel object made here would not be
  /// the simulated one that the tasks see. Notes that as unsupported.
  /// @return whether that is so, and the call must fail
  [[nodiscard]] static bool refuses_real(std::string_view call);

  [[nodiscard]] Scheduler& scheduler() noexcept { return scheduler_; }
  [[nodiscard]] const Scheduler& scheduler() const noexcept { return scheduler_; }
  [[nodiscard]] ObjectNames& objects() noexcept { return objects_; }
  [[nodiscard]] const ObjectNames& objects() const noexcept { return objects_; }
  [[nodiscard]] Segments& segments() noexcept { return segments_; }
  [[nodiscard]] const Segments& segments() const noexcept { return segments_; }
  [[nodiscard]] ProgramMemory& program_memory() noexcept { return program_memory_; }
  /// What memory holds now where `operation` acts, which has an object, as an unsigned number; of longer accesses the first
  /// eight bytes.
  [[nodiscard]] std::uint64_t value_at(const Operation& operation) const noexcept;
  [[nodiscard]] MemoryChecks& checks() noexcept { return checks_; }
  [[nodiscard]] WeakMemory& weak_memory() noexcept { return weak_; }
  [[nodiscard]] Semaphores& semaphores() noexcept { return semaphores_; }
  [[nodiscard]] SystemVSegments& system_v_segments() noexcept { return system_v_segments_; }
  [[nodiscard]] SystemVSemaphores& system_v_semaphores() noexcept { return system_v_semaphores_; }
  [[nodiscard]] Mutexes& mutexes() noexcept { return mutexes_; }
  [[nodiscard]] const Mutexes& mutexes() const noexcept { return mutexes_; }
  [[nodiscard]] Rwlocks& rwlocks() noexcept { return rwlocks_; }
  [[nodiscard]] const Rwlocks& rwlocks() const noexcept { return rwlocks_; }
  [[nodiscard]] SpinLocks& spin_locks() noexcept { return spin_locks_; }
  [[nodiscard]] const SpinLocks& spin_locks() const noexcept { return spin_locks_; }
  [[nodiscard]] Barriers& barriers() noexcept { return barriers_; }
  [[nodiscard]] const Barriers& barriers() const noexcept { return barriers_; }
  [[nodiscard]] StaticGuards& static_guards() noexcept { return static_guards_; }
  [[nodiscard]] const StaticGuards& static_guards() const noexcept { return static_guards_; }
  [[nodiscard]] ThreadSpecific& thread_specific() noexcept { return thread_specific_; }
  [[nodiscard]] RandomNumbers& random_numbers() noexcept { return random_numbers_; }
  /// For what the scenario has declared: the running task performs `operation` next.
  void check_step(const Task& task, const Operation& operation) noexcept {
    fetches_.performs(task, operation);
    written_first_.performs(task, operation);
  }
  [[nodiscard]] Threads& threads() noexcept { return threads_; }
  [[nodiscard]] Faults& faults() noexcept { return faults_; }
  [[nodiscard]] const Faults& faults() const noexcept { return faults_; }
  [[nodiscard]] Damages& damages() noexcept { return damages_; }
  [[nodiscard]] Signals& signals() noexcept { return signals_; }
  [[nodiscard]] Descriptors& descriptors() noexcept { return descriptors_; }
  [[nodiscard]] WholeState& whole_state() noexcept { return whole_state_; }

  /// What getpid(2) says in a process's present life: one that was started again is another one.
  [[nodiscard]] int system_id(ProcessId id) const noexcept {
    return first_system_id + id + static_cast<int>((incarnation(id) - 1) * processes_max);
  }
  static constexpr int first_system_id = 1000;

  [[nodiscard]] std::size_t processes_count() const noexcept { return processes_count_; }
  [[nodiscard]] Process& process(ProcessId id) noexcept { return *processes_[id]; }
  [[nodiscard]] const Process& process(ProcessId id) const noexcept { return *processes_[id]; }

  /// Never the same twice in a program, and nothing that ordinary memory holds by chance.
  [[nodiscard]] std::uint64_t execution_number() const noexcept { return execution_number_; }
  /// Whether some world gave that number to an execution.
  [[nodiscard]] static bool is_execution_number(std::uint64_t number) noexcept {
    return number >> execution_number_bits == execution_number_mark;
  }
  /// A call of the process for random bytes: each of all calls gets others, in each execution the same. By life and number, so that
  /// how often others have called makes no difference.
  [[nodiscard]] std::uint64_t next_random_draw(ProcessId id) noexcept {
    Process& process = *processes_[id];
    return std::uint64_t{id} << 48U | std::uint64_t{process.incarnation_} << 32U |
           process.random_draws_count_++;
  }
  /// Number of the next thread that the process creates, from 1.
  [[nodiscard]] unsigned next_thread_number(ProcessId id) noexcept {
    return ++processes_[id]->threads_created_count_;
  }
  [[nodiscard]] const std::string& process_name(ProcessId id) const noexcept {
    return processes_[id]->name();
  }
  [[nodiscard]] unsigned incarnation(ProcessId id) const noexcept { return processes_[id]->incarnation(); }

  [[nodiscard]] const std::function<void(const Exit&)>& exit() const noexcept { return exit_; }

  /// Scheduling point before `operation` of the running task on a synchronisation object. Ends the execution as a crash if that lies in
  /// memory that was freed.
  template <typename Object>
  void point_at(const Object* object, const Operation& operation) noexcept {
    if (ProgramMemory::is_on()) program_memory_.check_object(object, sizeof *object, operation.kind);
    scheduler_.point(operation);
    if (ProgramMemory::is_on()) program_memory_.check_object(object, sizeof *object, operation.kind);
  }

  /// The process ends with all its tasks, of its own accord or by a signal, and does not start again. Does not return if the running
  /// task is among them.
  void end_process(ProcessId id) noexcept;
  /// Nothing of the process runs any more, and what the system gave it is taken back. If the running task is among its own, that runs
  /// on until it leaves the scheduler.
  void close_down(ProcessId id) noexcept;

  /// The code under test called something that this world does not simulate. Ends the execution.
  void unsupported(std::string what);

  /// When the world begins the wall clock is this much ahead of the monotonic one: 2026-01-01T00:00:00Z.
  static constexpr SimTime wall_clock_epoch = std::chrono::seconds{1'767'225'600};
  /// An absolute time on a POSIX clock; all clocks but CLOCK_REALTIME begin with the world.
  [[nodiscard]] static Deadline to_deadline(clockid_t clock, const timespec& time) noexcept;
  /// @return  >= 0; VirtualClock::never: no limit
  [[nodiscard]] SimTime sim_time_of(Deadline deadline) const noexcept {
    if (!deadline.on_wall_clock || deadline.time == VirtualClock::never) return deadline.time;
    return std::max(deadline.time - wall_clock_ahead_, SimTime{0});
  }
  [[nodiscard]] timespec read_clock(clockid_t clock) noexcept;
  /// Blocks the running task until `deadline`.
  /// @return  what is left of the time if a fault has interrupted it, > 0; otherwise 0
  [[nodiscard]] SimTime sleep_until(Deadline deadline) noexcept;
  /// Asks whether the wall clock is set here, and sets it.
  void choose_clock_step() noexcept;

  [[nodiscard]] static WaitKey join_key(TaskId task) noexcept { return std::uint64_t{1} << 60U | task; }
  [[nodiscard]] static bool is_join_key(WaitKey key) noexcept { return key >> 60U == 1; }
  /// @param key  one for which is_join_key() holds
  [[nodiscard]] static TaskId task_of_join_key(WaitKey key) noexcept { return static_cast<TaskId>(key); }

 private:
  static constexpr unsigned execution_number_bits = StateHash::number_bits;
  static constexpr std::uint64_t execution_number_mark = 0x6c7453;
  // Of the last execution, of whichever world; with the mark, so that whoever comes upon it knows it for what it is.
  static inline std::uint64_t last_execution_number_ = execution_number_mark << execution_number_bits;

  Scheduler scheduler_{*this};
  ProgramMemory program_memory_{*this};
  ObjectNames objects_{program_memory_};
  Segments segments_{*this};
  MemoryChecks checks_{segments_.memory(),
                       ProgramMemory::is_on() ? ProgramMemory::places_end : segment_places_count};
  WeakMemory weak_{*this};
  Semaphores semaphores_{*this};
  SystemVSegments system_v_segments_{*this};
  SystemVSemaphores system_v_semaphores_{*this};
  Mutexes mutexes_{*this};
  Threads threads_{*this};
  Faults faults_{*this};
  Damages damages_{*this};
  SingleFetch fetches_{*this};
  WrittenFirst written_first_{*this};
  WholeState whole_state_{*this};
  Rwlocks rwlocks_{*this};
  SpinLocks spin_locks_{*this};
  Barriers barriers_{*this};
  StaticGuards static_guards_{*this};
  ThreadSpecific thread_specific_;
  RandomNumbers random_numbers_;
  Signals signals_{*this};
  Descriptors descriptors_;
  std::vector<std::unique_ptr<Process>>
      processes_;  // pooled; the first processes_count_ belong to this execution
  std::size_t processes_count_ = 0;
  Cpu default_cpu_ = Cpu::many;
  Memory default_memory_ = Memory::sc;
  Findings findings_;
  std::vector<std::string> input_records_;
  std::string input_;
  std::function<void(const Exit&)> exit_;
  std::string output_;
  std::uint64_t execution_number_ = 0;
  SimTime wall_clock_ahead_ = wall_clock_epoch;  // of the monotonic clock
};

}  // namespace ltsim
