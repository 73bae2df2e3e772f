// PLC_CHECK: the code contradicts itself, so it must not go on. Active in every build, unlike assert(), which
// CMake's Release and RelWithDebInfo both switch off. What a peer or a user can cause is never checked with
// it: that is a value (tl::expected) or a NAK.
#pragma once

#include <cstdio>
#include <cstdlib>

#define PLC_CHECK(condition)                                                                          \
  do {                                                                                                \
    if (!(condition)) [[unlikely]] {                                                                  \
      std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition); /* NOLINT */ \
      std::abort();                                                                                   \
    }                                                                                                 \
  } while (false)
