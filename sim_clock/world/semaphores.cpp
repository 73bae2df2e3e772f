#include "sim_clock/world/semaphores.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "sim_clock/world/object_key.hpp"
#include "sim_clock/world/same_name.hpp"
#include "sim_clock/world/segments.hpp"
#include "sim_clock/world/world.hpp"

namespace ltsim {
namespace {

static_assert(sizeof(Handle) <= sizeof(sem_t));

Operation operation_on(OperationKind kind, ObjectId object = 0) noexcept {
  return {.kind = kind, .object = object};
}

/// "/x" and "x" are one semaphore; there are no folders.
/// @return nothing for a name that glibc refuses
std::optional<std::string_view> plain_name(std::string_view name) noexcept {
  if (name.starts_with('/')) name.remove_prefix(1);
  if (name.empty() || name.find('/') != std::string_view::npos) return std::nullopt;
  return name;
}

}  // namespace

sem_t* Semaphores::open(std::string_view path, int flags, unsigned value) noexcept {
  // A name under which there is a semaphore has been looked at before.
  const std::string_view name = path.substr(path.starts_with('/') ? 1 : 0);
  Semaphore* const semaphore = find(name);
  if (semaphore == nullptr && !plain_name(path)) {
    errno = EINVAL;
    return SEM_FAILED;
  }
  if (semaphore != nullptr && (flags & O_CREAT) != 0 && (flags & O_EXCL) != 0) {
    errno = EEXIST;
    return SEM_FAILED;
  }
  if (semaphore == nullptr && (flags & O_CREAT) == 0) {
    errno = ENOENT;
    return SEM_FAILED;
  }
  if (semaphore == nullptr) {
    if (value > value_max) {
      errno = EINVAL;
      return SEM_FAILED;
    }
    return &create(name, name, value);
  }
  world_.scheduler().only_looked();
  return &handles_[static_cast<std::size_t>(semaphore - semaphores_.data())];
}

int Semaphores::close(sem_t* handle) noexcept {
  // No scheduling point: nobody can tell when it happens.
  static_cast<void>(resolve(handle, OperationKind::sem_close));
  return 0;
}

int Semaphores::unlink(std::string_view path) noexcept {
  Operation operation = operation_on(OperationKind::sem_unlink);
  operation.name = world_.scheduler().name_for_strategy([path] { return path; });
  world_.scheduler().point(operation);
  Semaphore* const semaphore = find(plain_name(path).value_or(""));
  if (semaphore == nullptr) {
    errno = ENOENT;
    return -1;
  }
  semaphore->linked = false;
  return 0;
}

int Semaphores::init(sem_t* handle, bool shared, unsigned value) noexcept {
  world_.scheduler().point(operation_on(OperationKind::sem_init));
  if (value > value_max) {
    errno = EINVAL;
    return -1;
  }
  std::memcpy(handle, &create({}, name_by_place(handle), value), sizeof(Handle));
  world_.segments().accept_change(handle, sizeof(Handle));
  semaphores_[count_ - 1].shared = shared;
  return 0;
}

std::string Semaphores::name_by_place(const sem_t* handle) const {
  const bool begins_a_segment =
      Segments::contains(handle) && Segments::offset_in_segment(Segments::place_of(handle)) == 0;
  if (!begins_a_segment) return world_.program_memory().object_name(handle, "semaphore", count_ + 1);
  return std::string{world_.objects().object_name(world_.segments().segment_at(Segments::place_of(handle)))};
}

int Semaphores::destroy(sem_t* handle) noexcept {
  arrive_at(handle, OperationKind::sem_destroy);
  std::memset(handle, 0, sizeof(Handle));
  world_.segments().accept_change(handle, sizeof(Handle));
  return 0;
}

int Semaphores::wait(sem_t* handle) noexcept {
  return wait_until(handle, OperationKind::sem_wait, VirtualClock::never);
}

int Semaphores::try_wait(sem_t* handle) noexcept {
  Semaphore& semaphore = arrive_at(handle, OperationKind::sem_trywait);
  if (semaphore.value == 0) {
    world_.scheduler().only_looked();
    errno = EAGAIN;
    return -1;
  }
  take_token(semaphore);
  return 0;
}

int Semaphores::timed_wait(sem_t* handle, clockid_t clock, const timespec& deadline) noexcept {
  if (deadline.tv_nsec < 0 || deadline.tv_nsec >= 1'000'000'000) {
    errno = EINVAL;
    return -1;
  }
  return wait_until(handle, OperationKind::sem_timedwait, world_.to_deadline(clock, deadline));
}

int Semaphores::post(sem_t* handle) noexcept {
  Semaphore& semaphore = arrive_at(handle, OperationKind::sem_post);
  if (world_.faults().strikes(FaultKind::lost_post)) [[unlikely]]
    return 0;
  add_one(semaphore);
  if (semaphore.value != value_max && world_.faults().strikes(FaultKind::doubled_post)) [[unlikely]]
    add_one(semaphore);
  return 0;
}

void Semaphores::add_one(Semaphore& semaphore) noexcept {
  if (semaphore.value >= semaphore.value_meant_max) [[unlikely]]
    exceeds_bound(semaphore, std::uint64_t{semaphore.value} + 1);
  ++semaphore.value;
  world_.checks().release(current_task->id, SyncKey::object(semaphore.object));
  world_.scheduler().wake(key_of(semaphore), 1);
}

int Semaphores::value(sem_t* handle, int& into) noexcept {
  into = static_cast<int>(arrive_at(handle, OperationKind::sem_getvalue).value);
  return 0;
}

int Semaphores::wait_until(sem_t* handle, OperationKind kind, Deadline deadline) noexcept {
  Semaphore& semaphore = arrive_at(handle, kind);
  if (semaphore.value == 0 && world_.faults().strikes(FaultKind::interrupt)) [[unlikely]] {
    errno = EINTR;
    return -1;
  }
  while (semaphore.value == 0) {
    if (world_.scheduler().block(key_of(semaphore), deadline) == Scheduler::Wake::timed_out &&
        semaphore.value == 0) {
      errno = ETIMEDOUT;
      return -1;
    }
  }
  take_token(semaphore);
  return 0;
}

unsigned Semaphores::value_of(ObjectId object) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (semaphores_[i].object == object) return semaphores_[i].value;
  }
  return 0;
}

void Semaphores::leave(std::string_view path, unsigned value) {
  const auto name = plain_name(path);
  if (!name || find(*name) != nullptr || value > value_max || count_ == semaphores_max) {
    world_.unsupported(fmt::format("a semaphore \"{}\" with value {} cannot be left over", path, value));
    return;
  }
  create(*name, *name, value);
}

void Semaphores::take_token(Semaphore& semaphore) noexcept {
  const SyncKey key = SyncKey::object(semaphore.object);
  world_.checks().acquire(current_task->id, key);
  // When no token is left, every post so far has been consumed: no later wait can come from one of them.
  if (--semaphore.value == 0) world_.checks().forget(key);
}

sem_t& Semaphores::create(std::string_view name, std::string_view shown_name, unsigned value) {
  if (count_ == semaphores_max)
    world_.unsupported(fmt::format("more than {} semaphores in one execution", semaphores_max));
  Semaphore& semaphore = semaphores_[count_];
  if (!is_same_name(semaphore.name, name)) semaphore.name.assign(name);
  semaphore.object = world_.objects().add(shown_name);
  semaphore.value = value;
  semaphore.linked = !name.empty();
  semaphore.shared = true;
  semaphore.value_meant_max = value_max;
  for (const Bound& bound : bounds_) {
    if (bound.name == shown_name) semaphore.value_meant_max = bound.count_max;
  }
  if (value > semaphore.value_meant_max) exceeds_bound(semaphore, value);
  sem_t& handle = handles_[count_];
  const Handle content{.execution = world_.execution_number(), .index = static_cast<std::uint32_t>(count_)};
  std::memcpy(&handle, &content, sizeof content);
  ++count_;
  return handle;
}

void Semaphores::bound(std::string_view name, unsigned count_max) {
  bounds_.push_back({.name = std::string{name}, .count_max = count_max});
}

void Semaphores::exceeds_bound(const Semaphore& semaphore, std::uint64_t value) {
  const GhostScope ghost;
  const std::string_view name = world_.objects().object_name(semaphore.object);
  world_.violated(value > value_max
                      ? fmt::format("semaphore {} is posted at its maximum, {} (EOVERFLOW)", name, value_max)
                      : fmt::format("semaphore {} has count {}, at most {} is meant (I10)", name, value,
                                    semaphore.value_meant_max));
}

Semaphores::Semaphore* Semaphores::find(std::string_view name) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (semaphores_[i].linked && is_same_name(semaphores_[i].name, name)) return &semaphores_[i];
  }
  return nullptr;
}

Semaphores::Semaphore& Semaphores::resolve(sem_t* handle, OperationKind kind) noexcept {
  Handle found;
  std::memcpy(static_cast<void*>(&found), handle, sizeof found);
  if (found.execution != world_.execution_number() || found.index >= count_) [[unlikely]] {
    const GhostScope ghost;
    world_.scheduler().fail(OutcomeKind::crash,
                            fmt::format("{} on memory that holds no semaphore", to_string(kind)));
  }
  return semaphores_[found.index];
}

Semaphores::Semaphore& Semaphores::arrive_at(sem_t* handle, OperationKind kind) noexcept {
  world_.point_at(handle, operation_on(kind, resolve(handle, kind).object));
  return resolve(handle, kind);
}

WaitKey Semaphores::key_of(const Semaphore& semaphore) noexcept {
  return object_key(semaphore.object, semaphore.shared);
}

void Semaphores::add_state(StateHash& hash) const noexcept {
  hash.add(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    hash.add(std::uint64_t{semaphores_[i].value} << 33U | std::uint64_t{semaphores_[i].linked} << 32U |
             semaphores_[i].object);
  }
}

}  // namespace ltsim
