// Who opens a segment of size 0 takes it for the leftover of a crash, unlinks it and makes a new one; its creator had
// just not given it a size yet (Stockfish #6977, PR #6979).

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <mutex>

#include "sim_clock/scenario/shape.hpp"
#include "tests/scenarios/races/shared.hpp"

namespace {

constexpr const char* segment_name = "/network";

struct Header {
  std::atomic<std::uint32_t> users;
};

int create() {
  const int descriptor = shm_open(segment_name, O_CREAT | O_EXCL | O_RDWR, 0600);
  if (descriptor >= 0 && ftruncate(descriptor, sizeof(Header)) != 0) return -1;
  return descriptor;
}

/// Creates the segment, or opens the one there is, unless it looks stale.
Header* attach() {
  int descriptor = create();
  if (descriptor < 0) {
    descriptor = shm_open(segment_name, O_RDWR, 0600);
    struct stat status{};
    if (descriptor < 0 || fstat(descriptor, &status) != 0) return nullptr;
    if (status.st_size == 0) {
      close(descriptor);
      shm_unlink(segment_name);
      descriptor = create();
    }
  }
  if (descriptor < 0) return nullptr;
  void* const memory = mmap(nullptr, sizeof(Header), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  close(descriptor);
  return static_cast<Header*>(memory);
}

}  // namespace

SHAPE("races/o27-reopen-race",
      {.finding = "I29",
       .depth = 1,
       .tasks_count = 2,
       .cure = "a lock around creating or opening, and giving the size"},
      "a segment that is being created is taken for a leftover") {
  races::name_words(world, "network", {"users"});
  unsigned attached_count = 0;

  for (const char* const name : {"one", "two"}) {
    world.process(name).start("main", [&] {
      races::NamedLock lock{"attach"};
      std::unique_lock guard{lock, std::defer_lock};
      if (corrected) guard.lock();
      Header* const header = attach();
      if (header == nullptr) return;
      const std::uint32_t users = ++header->users;
      world.require(users == ++attached_count, "I29: two segments were made under one name");
    });
  }
  world.run();
}
