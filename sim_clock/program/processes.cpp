#include "sim_clock/program/processes.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include "sim_clock/program/exit_handlers.hpp"
#include "sim_clock/program/launch.hpp"
#include "sim_clock/program/main_arguments.hpp"
#include "sim_clock/program/process_options.hpp"
#include "sim_clock/program/program_executions.hpp"

namespace ltsim {
namespace {

using Main = int (*)(int, char**, char**);

class Processes {
 public:
  Processes(const WorldOptions& options, const std::vector<Main>& mains, char** environment)
      : options_(options), mains_(mains), environment_(environment), arguments_(mains.size()) {}

  void prepare() { executions_.prepare(); }

  void execute(World& world) {
    executions_.begin();
    services_are_ready_ = false;
    if (options_.points_max != 0) world.set_points_max(options_.points_max);
    if (options_.is_steady) world.set_steady();
    world.set_exit([this, &world](const World::Exit& how) { exit(world, how); });
    for (const ProcessOptions& options : options_.processes) {
      Process& process = world.process(options.name);
      process.start("main", [this, &world] { run_main(world); });
      if (options.crash) process.may_crash(*options.crash);
      if (options.stalls != 0) process.may_stall(options.stalls);
    }
    for (const WorldOptions::Fault& fault : options_.faults) world.grant(fault.kind, fault.times);
    world.whenever_idle([this, &world] { look_at_services(world); });
    executions_.run(world);
  }

 private:
  static constexpr WaitKey services_are_ready_key = WaitKey{1} << 59U;

  void run_main(World& world) {
    const ProcessId id = current_task->process;
    while (!services_are_ready_ && !options_.processes[id].is_service)
      world.scheduler().block(services_are_ready_key, VirtualClock::never);
    {
      const GhostScope ghost;
      if (world.incarnation(id) != 1) executions_.begin_again(id);
      arguments_[id].begin(options_.processes[id].arguments);
    }
    const int status = mains_[id](arguments_[id].count(), arguments_[id].pointers(), environment_);
    exit(world, {.status = status, .stack = __builtin_frame_address(0)});
  }

  void exit(World& world, const World::Exit& how) {
    const ProcessId id = current_task->process;
    if (how.is_orderly) {
      Scheduler::destroy_thread_locals(*current_task);
      ExitHandlers::run(id);
      world.program_memory().check_leaks(how.stack);
    }
    const int status = how.status & exit_status_mask;
    const auto& harmless = options_.exit_statuses;
    if (std::find(harmless.begin(), harmless.end(), status) == harmless.end())
      world.scheduler().fail(OutcomeKind::exit,
                             fmt::format("{} ended with status {}", options_.processes[id].name, status));
    check_time(world);
    world.end_process(id);
  }

  [[nodiscard]] bool all_of(World& world, bool services, bool (*holds)(World&, ProcessId)) const {
    for (std::size_t i = 0; i < options_.processes.size(); ++i) {
      const auto id = static_cast<ProcessId>(i);
      if (options_.processes[i].is_service == services && !holds(world, id)) return false;
    }
    return true;
  }

  static bool has_ended(World& world, ProcessId id) { return !world.scheduler().has_unfinished_tasks(id); }
  static bool waits_to_be_stopped(World& world, ProcessId id) {
    return world.signals().is_waited_for(id, SIGTERM);
  }

  /// Nobody can run just now.
  void look_at_services(World& world) {
    check_time(world);
    using namespace std::chrono_literals;
    constexpr SimTime patience = 60s;
    if (!services_are_ready_) {
      services_are_ready_ = all_of(world, true, [](World& of, ProcessId id) {
        return has_ended(of, id) || waits_to_be_stopped(of, id);
      });
      if (services_are_ready_) world.scheduler().wake(services_are_ready_key, tasks_max);
      if (!services_are_ready_ && world.now() > patience)
        world.unsupported(
            "a service has not waited for SIGTERM within 60 s: it must, with sigwait(3) or its kind, or be a "
            "--process");
    } else if (all_of(world, false, &has_ended)) {
      // One that is just being started again is stopped later.
      for (std::size_t i = 0; i < options_.processes.size(); ++i) {
        const auto id = static_cast<ProcessId>(i);
        if (options_.processes[i].is_service && waits_to_be_stopped(world, id))
          world.signals().send(id, SIGTERM);
      }
    }
  }

  void check_time(World& world) {
    if (!options_.within || world.now() <= *options_.within) return;
    std::string names;
    for (std::size_t i = 0; i < options_.processes.size(); ++i) {
      if (!has_ended(world, static_cast<ProcessId>(i)))
        names += (names.empty() ? "" : ", ") + options_.processes[i].name;
    }
    world.violated(
        fmt::format("after {} s there are still {}", *options_.within / std::chrono::seconds{1}, names));
  }

  const WorldOptions& options_;
  const std::vector<Main>& mains_;
  char** environment_;
  ProgramExecutions executions_;
  std::vector<MainArguments> arguments_;
  bool services_are_ready_ = false;
};

/// What the loader is to load, under a name of its own: it loads no file twice.
/// @return  empty: no copy could be made
std::string copy_of(const std::string& path) {
  const int from = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const int to = memfd_create("ltsim-image", MFD_CLOEXEC);
  struct stat status{};
  const bool is_copied =
      from >= 0 && to >= 0 && fstat(from, &status) == 0 &&
      sendfile(to, from, nullptr, static_cast<std::size_t>(status.st_size)) == status.st_size;
  if (from >= 0) close(from);
  return is_copied ? fmt::format("/proc/self/fd/{}", to) : "";
}

/// @param path        lives as long as the program
/// @param is_another  of a file that was loaded already
/// @return  its main(); null: it was told why not
Main load(const std::string& path, bool is_another) {
  const std::string file = is_another ? copy_of(path) : std::filesystem::absolute(path).string();
  const std::size_t count = ProgramImage::count();
  ProgramImage::expect(path.c_str());
  ProgramHeap::serve_outside_tasks(true);
  void* const image = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  ProgramHeap::serve_outside_tasks(false);
  if (image == nullptr) {
    fmt::print(stderr, "ltsim: {}\n", dlerror());
    return nullptr;
  }
  void* const main = dlsym(image, "main");
  if (ProgramImage::count() == count || main == nullptr) {
    fmt::print(stderr, "ltsim: {}: was not built and linked with ltsim-c++ --process\n", path);
    return nullptr;
  }
  ProgramHeap::end_of_image();
  return reinterpret_cast<Main>(main);
}

}  // namespace

int run_processes(const std::vector<std::string>& arguments, char** environment,
                  const std::vector<std::string>& command) {
  constexpr int bad_usage = 2;
  constexpr int own_fault = 3;
  const auto options = parse_process_options(arguments);
  if (!options) {
    fmt::print(stderr, "ltsim: {}\n", options.error());
    return bad_usage;
  }
  ProgramImage::forget_program();
  if (const auto trouble = ProgramMemory::turn_on(); trouble) {
    fmt::print(stderr, "ltsim: {}\n", *trouble);
    return own_fault;
  }
  std::vector<Main> mains;
  const auto& all = options->processes;
  for (auto process = all.begin(); process != all.end(); ++process) {
    const std::string& path = process->arguments.front();
    const bool is_another = std::any_of(
        all.begin(), process, [&](const ProcessOptions& other) { return other.arguments.front() == path; });
    const Main main = load(path, is_another);
    if (main == nullptr) return bad_usage;
    mains.push_back(main);
  }
  Processes processes{*options, mains, environment};
  std::vector<std::string> program{processes_program};
  program.insert(program.end(), arguments.begin(), arguments.end());
  const std::string name = options->name();
  return run_program_command({.name = name,
                              .description = "whole programs as processes",
                              .body = [&processes](World& world) { processes.execute(world); },
                              .program = std::move(program),
                              .prepare = [&processes] { processes.prepare(); }},
                             command);
}

}  // namespace ltsim
