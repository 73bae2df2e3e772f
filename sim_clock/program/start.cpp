// In the shared library that whole programs are linked with: takes over where a program begins, what it registers for its exit, and
// operator new. Called as any program is, with no command of ltsim in its environment, a program does what it always does.

#include <dlfcn.h>
#include <malloc.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "sim_clock/program/exit_handlers.hpp"
#include "sim_clock/program/launch.hpp"
#include "sim_clock/program/processes.hpp"
#include "sim_clock/program/whole_program.hpp"
#include "sim_clock/takeover/program_blocks.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

using Main = int (*)(int, char**, char**);

Main program_main = nullptr;
std::optional<std::vector<std::string>> launch_command;

int run_in_world(int count, char** arguments, char** environment) {
  ProgramHeap::serve_outside_tasks(false);
  const ProgramStart start{
      .main = program_main, .arguments = {arguments, arguments + count}, .environment = environment};
  return run_whole_program(start, *launch_command);
}

/// Tasks have thread-local storage of their own, so malloc would take them for threads, and make an arena for each.
void make_one_arena() noexcept { mallopt(M_ARENA_MAX, 1); }

/// @return null: there is no room
void* new_block(std::size_t bytes, std::size_t alignment, const void* caller) noexcept {
  if (ProgramHeap::serves(caller)) return allocate_for_program(bytes, alignment, caller);
  return alignment <= alignof(std::max_align_t)
             ? std::malloc(bytes)
             : std::aligned_alloc(alignment, (bytes + alignment - 1) & ~(alignment - 1));
}

void* new_block_or_throw(std::size_t bytes, std::size_t alignment, const void* caller) {
  if (void* const block = new_block(bytes, alignment, caller); block != nullptr) return block;
  throw std::bad_alloc{};
}

void delete_block(void* block, const void* caller) noexcept {
  if (ProgramHeap::contains(block)) {
    free_of_program(block, caller);
  } else {
    std::free(block);
  }
}

constexpr std::size_t usual = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace
}  // namespace ltsim

using ltsim::ProgramHeap;

/// libc's, which a program's first instructions call; it runs the constructors of the program's static objects, then main().
extern "C" int __libc_start_main(ltsim::Main main, int count, char** arguments, void (*init)(),
                                 void (*fini)(), void (*rtld_fini)(), void* stack_end) {
  using Start = int (*)(ltsim::Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto next = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  ltsim::launch_command = ltsim::take_launch_command(ltsim::LaunchedProgram::whole);
  if (!ltsim::launch_command) return next(main, count, arguments, init, fini, rtld_fini, stack_end);
  if (const auto trouble = ltsim::ProgramMemory::turn_on(); trouble) {
    std::fprintf(stderr, "ltsim: %s\n", trouble->c_str());
    std::exit(3);
  }
  ltsim::make_one_arena();
  ltsim::program_main = main;
  ProgramHeap::serve_outside_tasks(true);
  return next(&ltsim::run_in_world, count, arguments, init, fini, rtld_fini, stack_end);
}

/// main() of ltsim-processes.
extern "C" int ltsim_run_processes(int count, char** arguments, char** environment) {
  const auto command = ltsim::take_launch_command(ltsim::LaunchedProgram::processes);
  if (!command) {
    std::fputs("ltsim-processes: is run by ltsim: ltsim explore --process IMAGE:ARGUMENTS ...\n", stderr);
    return 2;
  }
  ltsim::make_one_arena();
  return ltsim::run_processes({arguments + 1, arguments + count}, environment, *command);
}

extern "C" int __cxa_atexit(void (*function)(void*), void* argument, void* module) {
  using ltsim::ProgramImage;
  const bool is_before_main = ProgramHeap::serves_outside_tasks() && ProgramImage::contains(module);
  if (ltsim::current_task != nullptr || is_before_main) {
    const auto process = is_before_main ? static_cast<ltsim::ProcessId>(ProgramImage::image_of(module))
                                        : ltsim::current_task->process;
    ltsim::ExitHandlers::add(process, {function, argument});
    return 0;
  }
  using Register = int (*)(void (*)(void*), void*, void*);
  static const auto next = reinterpret_cast<Register>(dlsym(RTLD_NEXT, "__cxa_atexit"));
  return next(function, argument, module);
}

// operator new asks for memory in libstdc++: who really asks would not be known there.

#define LTSIM_NEW(name, alignment, function, ...)                                                    \
  void* name(__VA_ARGS__) {                                                                          \
    return ltsim::function(bytes, static_cast<std::size_t>(alignment), __builtin_return_address(0)); \
  }
LTSIM_NEW(operator new, ltsim::usual, new_block_or_throw, std::size_t bytes)
LTSIM_NEW(operator new[], ltsim::usual, new_block_or_throw, std::size_t bytes)
LTSIM_NEW(operator new, alignment, new_block_or_throw, std::size_t bytes, std::align_val_t alignment)
LTSIM_NEW(operator new[], alignment, new_block_or_throw, std::size_t bytes, std::align_val_t alignment)

#define LTSIM_NEW_NOTHROW(name, alignment, ...)                                                       \
  void* name(__VA_ARGS__, const std::nothrow_t& /*tag*/) noexcept {                                   \
    return ltsim::new_block(bytes, static_cast<std::size_t>(alignment), __builtin_return_address(0)); \
  }
LTSIM_NEW_NOTHROW(operator new, ltsim::usual, std::size_t bytes)
LTSIM_NEW_NOTHROW(operator new[], ltsim::usual, std::size_t bytes)
LTSIM_NEW_NOTHROW(operator new, alignment, std::size_t bytes, std::align_val_t alignment)
LTSIM_NEW_NOTHROW(operator new[], alignment, std::size_t bytes, std::align_val_t alignment)

#define LTSIM_DELETE(name, ...)                                \
  void name(void* block __VA_OPT__(, ) __VA_ARGS__) noexcept { \
    ltsim::delete_block(block, __builtin_return_address(0));   \
  }
#define LTSIM_DELETES(name)                         \
  LTSIM_DELETE(name)                                \
  LTSIM_DELETE(name, std::size_t)                   \
  LTSIM_DELETE(name, std::align_val_t)              \
  LTSIM_DELETE(name, std::size_t, std::align_val_t) \
  LTSIM_DELETE(name, const std::nothrow_t&)         \
  LTSIM_DELETE(name, std::align_val_t, const std::nothrow_t&)
LTSIM_DELETES(operator delete)
LTSIM_DELETES(operator delete[])
