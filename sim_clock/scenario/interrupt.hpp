// SIGINT and SIGTERM as a request to stop and tell what has been found.
#pragma once

#include <csignal>

namespace ltsim {

/// While it lives, the first of these signals only sets signal(); one that comes more than a second later ends the program. One
/// guard at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// @return 0: none has come
  [[nodiscard]] static int signal() noexcept;

 private:
  struct sigaction previous_int_{};
  struct sigaction previous_term_{};
};

}  // namespace ltsim
