// LTSIM_CHECK: the simulator contradicts itself. It says so and ends the program with exit code 3, so that it
// can never be mistaken for a finding about the code under test. Active in every build.
#pragma once

namespace ltsim {

/// Prints "ltsim: internal error: ..." and ends the program with exit code 3, running nothing else.
[[noreturn]] void internal_error(const char* file, int line, const char* what) noexcept;

}  // namespace ltsim

#define LTSIM_CHECK(condition)                                 \
  do {                                                         \
    if (!(condition)) [[unlikely]]                             \
      ::ltsim::internal_error(__FILE__, __LINE__, #condition); \
  } while (false)

/// This place is never reached; if it is, the text says what went wrong.
#define LTSIM_UNREACHABLE(text) ::ltsim::internal_error(__FILE__, __LINE__, text)
