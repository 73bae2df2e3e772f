// The definition that ours stands in front of: libc's, for calls made outside the simulated world.
#pragma once

#include <dlfcn.h>

/// LTSIM_NEXT(sem_post)(semaphore) calls what sem_post would be without us. Looked up once.
#define LTSIM_NEXT(function)                                                                        \
  ([] {                                                                                             \
    static auto* const next = reinterpret_cast<decltype(&::function)>(dlsym(RTLD_NEXT, #function)); \
    return next;                                                                                    \
  }())
