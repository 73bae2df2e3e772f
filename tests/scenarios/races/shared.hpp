// What the programs of the known races are made of: a segment laid out as a structure of atomic words, and named
// semaphores as doorbells and as locks. Each process, or thread, opens what it uses by name.
//
// All words are atomic, also where the source of a race has plain ones: these programs are about protocols that are wrong
// by what they read, and no data race is to tell. Memory orders are the default ones, but in the races that need a weak
// memory (ShapeFacts::memory).
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <thread>

#include <boost/date_time/posix_time/posix_time_types.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/shared_memory_object.hpp>
#include <boost/interprocess/sync/named_semaphore.hpp>

#include "sim_clock/world/world.hpp"

namespace races {

using Milliseconds = std::chrono::milliseconds;

/// A segment, opened or created; a new one is all zeros.
template <typename Layout>
class Shared {
 public:
  explicit Shared(const char* segment) {
    namespace ipc = boost::interprocess;
    ipc::shared_memory_object object(ipc::open_or_create, segment, ipc::read_write);
    object.truncate(sizeof(Layout));
    ipc::mapped_region{object, ipc::read_write, 0, sizeof(Layout)}.swap(memory_);
  }

  Layout* operator->() const noexcept { return static_cast<Layout*>(memory_.get_address()); }
  Layout& operator*() const noexcept { return *operator->(); }

 private:
  boost::interprocess::mapped_region memory_;
};

/// A named semaphore, opened or created with a count.
class Doorbell {
 public:
  explicit Doorbell(const char* name, unsigned count = 0)
      : semaphore_(boost::interprocess::open_or_create, name, count) {}

  void ring() { semaphore_.post(); }
  void wait() { semaphore_.wait(); }
  [[nodiscard]] bool wait_for(Milliseconds timeout) {
    return semaphore_.timed_wait(boost::posix_time::microsec_clock::universal_time() +
                                 boost::posix_time::milliseconds(timeout.count()));
  }
  /// Takes one count if there is one.
  bool try_take() { return semaphore_.try_wait(); }

 private:
  boost::interprocess::named_semaphore semaphore_;
};

/// A lock between processes: a semaphore of count 1. Fits std::lock_guard.
class NamedLock {
 public:
  explicit NamedLock(const char* name) : semaphore_(boost::interprocess::open_or_create, name, 1) {}
  void lock() { semaphore_.wait(); }
  void unlock() { semaphore_.post(); }

 private:
  boost::interprocess::named_semaphore semaphore_;
};

/// Looks again and again, a millisecond apart, at most ten times. A semaphore instead would order memory as well.
/// @return whether it has come to hold
template <typename Condition>
[[nodiscard]] bool poll_until(Condition holds) {
  constexpr int looks_max = 10;
  for (int look = 0; look < looks_max; ++look) {
    if (holds()) return true;
    std::this_thread::sleep_for(Milliseconds{1});
  }
  return false;
}

/// Names the first words of a segment, 32 bits each, "segment.word".
inline void name_words(ltsim::World& world, const std::string& segment,
                       std::initializer_list<const char*> words) {
  std::uint32_t offset = 0;
  for (const char* const word : words) {
    world.name_region(segment, offset, sizeof(std::uint32_t), segment + "." + word);
    offset += sizeof(std::uint32_t);
  }
}

}  // namespace races
