#include "protocol/hardened/doorbell.hpp"

#include <fcntl.h>

#include <utility>

#include "protocol/deadline.hpp"

namespace protocol::hardened {

bool Doorbell::open(const std::string& name) noexcept {
  close();
  constexpr mode_t owner_only = 0600;
  sem_t* const opened = ::sem_open(('/' + name).c_str(), O_CREAT, owner_only, 0U);
  if (opened == SEM_FAILED) return false;
  semaphore_ = opened;
  return true;
}

void Doorbell::close() noexcept {
  if (semaphore_ != nullptr) ::sem_close(std::exchange(semaphore_, nullptr));
}

bool Doorbell::remove(const std::string& name) noexcept { return ::sem_unlink(('/' + name).c_str()) == 0; }

void Doorbell::ring() const noexcept { static_cast<void>(::sem_post(semaphore_)); }

void Doorbell::wait() const noexcept { static_cast<void>(::sem_wait(semaphore_)); }

void Doorbell::wait_until(std::chrono::steady_clock::time_point deadline) const noexcept {
  const timespec until = on_monotonic_clock(deadline);
  static_cast<void>(::sem_clockwait(semaphore_, CLOCK_MONOTONIC, &until));
}

bool Doorbell::try_take() const noexcept { return ::sem_trywait(semaphore_) == 0; }

void Doorbell::empty() const noexcept {
  while (try_take()) {
  }
}

}  // namespace protocol::hardened
