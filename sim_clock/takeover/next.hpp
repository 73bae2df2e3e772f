// The definition that ours stands in front of: libc's, for calls made outside the simulated world.
#pragma once

#include <dlfcn.h>

/// LTSIM_NEXT(sem_post)(semaphore) calls what sem_post would be without us. Looked up once. Out of line, so that a takeover
/// function does not save registers for the look-up each time that a simulated task calls it.
#define LTSIM_NEXT(function)                                                                        \
  ([]() __attribute__((noinline, cold)) {                                                           \
    static auto* const next = reinterpret_cast<decltype(&::function)>(dlsym(RTLD_NEXT, #function)); \
    return next;                                                                                    \
  }())
