#include "sim_clock/world/world.hpp"

#include <sys/single_threaded.h>

#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/format.h>

#include "sim_clock/check/race_text.hpp"
#include "sim_clock/check/self_check.hpp"
#include "sim_clock/world/same_name.hpp"
#include "sim_clock/world/watched_accesses.hpp"

namespace ltsim {

void Process::start(std::string_view name, std::function<void()> body) {
  const Task& task = world_.scheduler().create_task(id_, name, std::move(body));
  if (current_task != nullptr) world_.checks().follows(task.id, current_task->id);
}

void Process::may_crash(CrashGrant grant) { world_.faults().grant_crashes(id_, grant); }

void Process::may_stall(unsigned times) { world_.faults().grant_stalls(id_, times); }

bool Process::is_running() const noexcept {
  return world_.scheduler().has_unfinished_tasks(id_) && world_.now() >= begin_;
}

void Process::remember_tasks() {
  starts_.clear();
  for (std::size_t i = 0; i < world_.scheduler().tasks_count(); ++i) {
    const Task& task = world_.scheduler().task(static_cast<TaskId>(i));
    if (task.process == id_) starts_.push_back({task.name.substr(name_.size() + 1), task.body});
  }
}

void Process::died(std::optional<SimTime> restart_after) {
  ++crashes_;
  if (!restart_after) return;
  ++incarnation_;
  threads_created_count_ = 0;
  random_draws_count_ = 0;
  begin_ = world_.now() + *restart_after;
  const UnwatchedWrites unwatched;
  const std::size_t tasks_before = world_.scheduler().tasks_count();
  for (const Start& start : starts_) {
    Task& task = world_.scheduler().create_task(id_, start.task, start.body);
    world_.scheduler().delay_start(task, begin_);
    world_.weak_memory().starts_again(task.id);
    for (std::size_t i = 0; i < tasks_before; ++i) {
      const Task& dead = world_.scheduler().task(static_cast<TaskId>(i));
      if (dead.process == id_) world_.checks().follows(task.id, dead.id);
    }
  }
}

void Process::reset() noexcept {
  threads_created_count_ = 0;
  random_draws_count_ = 0;
  incarnation_ = 1;
  crashes_ = 0;
  begin_ = SimTime{0};
  starts_.clear();
}

namespace {

bool a_world_exists = false;
World* in_execution = nullptr;

/// Whether the task is called so, in whichever life of its process: "emulator@2/main" is an "emulator/main".
bool is_called(const Task& task, std::size_t process_name_length, std::string_view name) noexcept {
  if (task.name == name) return true;
  const std::string_view full = task.name;
  const std::size_t slash = full.find('/', process_name_length);
  return full[process_name_length] == '@' && slash != std::string_view::npos &&
         name.starts_with(full.substr(0, process_name_length)) &&
         name.substr(process_name_length) == full.substr(slash);
}

}  // namespace

World::World() {
  LTSIM_CHECK(!a_world_exists);
  a_world_exists = true;
  // Tasks are threads: libstdc++ must not take its short cuts for programs with one thread only, which leave
  // reference counts and guards of static variables without protection.
  __libc_single_threaded = 0;
  if (ProgramMemory::is_on()) checks_.follow_family();
}

World::~World() {
  a_world_exists = false;
  in_execution = nullptr;
}

void World::run() {
  if (faults_.crash_is_possible()) faults_.prepare_restarts();
  scheduler_.run();
  if (scheduler_.is_abandoned()) throw Abandoned{};
  // Now, and not when the execution ends: what the scenario itself may do to the memory comes after.
  if (!failed()) segments_.check_all_memory();
}

void World::end_execution() noexcept {
  in_execution = nullptr;
  if (failed() || scheduler_.is_abandoned()) return;
  if (const auto race = checks_.race()) {
    scheduler_.fail(OutcomeKind::data_race, describe(*race, *this));
    return;
  }
  if (!findings_.leaks) return;
  std::string held = mutexes_.held_at_end();
  for (std::string& more : std::array{rwlocks_.held_at_end(), spin_locks_.held_at_end()}) {
    if (!more.empty()) held += (held.empty() ? "" : "; ") + more;
  }
  if (!held.empty()) scheduler_.fail(OutcomeKind::leak, std::move(held));
}

std::uint64_t World::value_at(const Operation& operation) const noexcept {
  return ProgramMemory::is_object(operation.object) ? ProgramMemory::value_at(operation)
                                                    : segments_.value_at(operation);
}

bool World::refuses_real(std::string_view call) {
  if (in_execution == nullptr) return false;
  in_execution->unsupported(
      fmt::format("{} was called by the scenario outside its tasks: the tasks would not see what it makes. "
                  "Call it in a task",
                  call));
  return true;
}

Process& World::process(std::string_view name) {
  for (std::size_t i = 0; i < processes_count_; ++i) {
    if (is_same_name(processes_[i]->name(), name)) return *processes_[i];
  }
  if (processes_count_ == Segments::processes_max) {
    unsupported(fmt::format("more than {} processes in one world", Segments::processes_max));
    return *processes_.back();  // set-up goes on, but nothing will run
  }
  const std::size_t id = processes_count_++;
  if (id == processes_.size()) processes_.emplace_back();
  // The next execution of a scenario makes the same processes in the same order: their objects are used
  // again.
  if (processes_[id] == nullptr || !is_same_name(processes_[id]->name(), name)) {
    processes_[id] = std::make_unique<Process>(*this, static_cast<ProcessId>(id), name);
  }
  processes_[id]->reset();
  return *processes_[id];
}

void World::require(bool holds, std::string_view message) {
  if (!holds && !failed()) violated(std::string{message});
}

std::string World::blocked_in(std::string_view task_name) const {
  for (std::size_t i = scheduler_.tasks_count(); i-- > 0;) {
    const Task& task = scheduler_.task(static_cast<TaskId>(i));
    if (!is_called(task, process_name(task.process).size(), task_name)) continue;
    if (task.state != Task::State::blocked) return {};
    return fmt::format("{} {}", to_string(scheduler_.pending(task).kind),
                       objects_.name(scheduler_.pending(task)));
  }
  return {};
}

void World::set_input(std::vector<std::string> records) {
  input_records_ = std::move(records);
  input_.clear();
  for (const std::string& record : input_records_) input_ += record;
}

void World::reset(Strategy& strategy, StepListener* listener) {
  execution_number_ = ++last_execution_number_;
  wall_clock_ahead_ = wall_clock_epoch;
  exit_ = nullptr;
  output_.clear();
  in_execution = this;
  scheduler_.reset(strategy, listener);
  scheduler_.set_cpu(default_cpu_);
  objects_.reset();
  segments_.reset();
  checks_.reset();
  if (!findings_.races) checks_.allow_races();
  weak_.reset();
  if (default_memory_ == Memory::c11) set_memory(Memory::c11);
  semaphores_.reset();
  system_v_segments_.reset();
  system_v_semaphores_.reset();
  mutexes_.reset();
  rwlocks_.reset();
  spin_locks_.reset();
  barriers_.reset();
  static_guards_.reset();
  thread_specific_.reset();
  random_numbers_.reset();
  signals_.reset();
  // Of whole programs all that are left open are closed, whatever has opened them.
  descriptors_.reset(!ProgramMemory::is_on());
  faults_.reset();
  damages_.reset();
  fetches_.reset();
  written_first_.reset();
  processes_count_ = 0;
}

void World::add_state(StateHash& hash) const noexcept {
  scheduler_.add_state(hash);
  segments_.add_state(hash);
  semaphores_.add_state(hash);
  system_v_segments_.add_state(hash);
  system_v_semaphores_.add_state(hash);
  mutexes_.add_state(hash);
  rwlocks_.add_state(hash);
  spin_locks_.add_state(hash);
  barriers_.add_state(hash);
  static_guards_.add_state(hash);
  thread_specific_.add_state(hash);
  random_numbers_.add_state(hash);
  signals_.add_state(hash);
  faults_.add_state(hash);
  damages_.add_state(hash);
  fetches_.add_state(hash);
  written_first_.add_state(hash);
  hash.add(static_cast<std::uint64_t>(wall_clock_ahead_.count()));
  for (std::size_t i = 0; i < processes_count_; ++i) {
    const Process& process = *processes_[i];
    hash.add(process.threads_created_count_);
    hash.add(process.random_draws_count_);
    hash.add(process.incarnation_);
    hash.add(process.crashes_);
    // Once a life has begun, when that was is asked by nobody.
    hash.add(static_cast<std::uint64_t>(now() < process.begin_ ? process.begin_.count() : 0));
  }
}

void World::set_memory(Memory memory) {
  if (memory == this->memory()) return;
  if (scheduler_.tasks_count() != 0 || memory == Memory::sc) {
    unsupported(memory == Memory::sc ? "a scenario for memory sc alone: it was asked to run with c11"
                                     : "World::set_memory() after a task was made");
    return;
  }
  weak_.turn_on();
  checks_.follow_order();
}

void World::close_down(ProcessId id) noexcept {
  scheduler_.kill_tasks(id);
  system_v_semaphores_.process_died(id);  // after that: no task of the process must be woken
  segments_.process_died(id);
  descriptors_.process_died(id);
  signals_.process_died(id);
}

void World::end_process(ProcessId id) noexcept {
  {
    const GhostScope ghost;
    note([&] { return fmt::format("{} ends", process_name(id)); });
    close_down(id);
  }
  if (current_task != nullptr && current_task->process == id) scheduler_.leave_killed();
}

void World::unsupported(std::string what) {
  const GhostScope ghost;
  scheduler_.fail(OutcomeKind::unsupported, std::move(what));
}

void World::grant(FaultKind kind, unsigned times) {
  if (kind == FaultKind::crash || kind == FaultKind::process_stall || kind == FaultKind::bit_flip ||
      kind == FaultKind::foreign_write) {
    unsupported(fmt::format(
        "{} is not granted to a whole world: see Process::may_crash, Process::may_stall and World::grant_in",
        to_string(kind)));
    return;
  }
  faults_.grant(kind, times);
}

void World::grant_in(FaultKind kind, std::string_view segment, std::uint32_t offset, std::uint32_t bytes,
                     unsigned times) {
  if (kind != FaultKind::bit_flip && kind != FaultKind::foreign_write) {
    unsupported(fmt::format("{} does not strike in a segment", to_string(kind)));
    return;
  }
  damages_.grant(kind, segment, offset, bytes, times);
}

Deadline World::to_deadline(clockid_t clock, const timespec& time) noexcept {
  // A deadline before the world's begin is simply due; one beyond the clock's range never comes.
  constexpr std::int64_t seconds_max = VirtualClock::never.count() / 1'000'000'000 - 1;
  if (time.tv_sec > seconds_max) return VirtualClock::never;
  if (time.tv_sec < 0) return SimTime{0};
  const SimTime since_begin = std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
  return clock == CLOCK_REALTIME ? Deadline::on_wall_clock_at(since_begin) : Deadline{since_begin};
}

timespec World::read_clock(clockid_t clock) noexcept {
  scheduler_.clock_was_read();
  scheduler_.point({.kind = OperationKind::clock_read});
  SimTime time = now();
  if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI) {
    choose_clock_step();
    time += wall_clock_ahead_;
  }
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  return {.tv_sec = seconds.count(), .tv_nsec = (time - seconds).count()};
}

SimTime World::sleep_until(Deadline deadline) noexcept {
  scheduler_.point({.kind = OperationKind::sleep});
  constexpr WaitKey nobody_wakes = 0;
  if (now() < sim_time_of(deadline)) {
    constexpr std::size_t ways = 2;  // at once, and half-way
    if (const std::size_t way = faults_.strike(FaultKind::interrupt, ways); way != 0) {
      if (way == 2) {
        scheduler_.block(nobody_wakes, now() + (sim_time_of(deadline) - now()) / 2);
      }
      return std::max(sim_time_of(deadline) - now(), SimTime{1});
    }
  }
  while (now() < sim_time_of(deadline)) scheduler_.block(nobody_wakes, deadline);
  return SimTime{0};
}

void World::choose_clock_step() noexcept {
  using namespace std::chrono_literals;
  constexpr std::array<SimTime, 8> steps{1s, 1min, 1h, 24h, -1s, -1min, -1h, -24h};
  const std::size_t variant = faults_.strike(FaultKind::clock_step, steps.size());
  if (variant == 0) return;
  const SimTime step = steps[variant - 1];
  note([&] { return fmt::format("the wall clock is set by {} s", step / 1s); });
  wall_clock_ahead_ += step;
  scheduler_.wall_clock_was_stepped(step);
}

}  // namespace ltsim
