// Shared memory of the simulated world, through the ordinary calls.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>

#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

class SegmentsTest : public WorldTest {
 protected:
  static constexpr std::size_t segment_bytes = 100;

  static unsigned char* open_and_map() {
    const int descriptor = shm_open("/segment", O_CREAT | O_RDWR, 0600);
    if (ftruncate(descriptor, segment_bytes) != 0) return nullptr;
    void* const address = mmap(nullptr, segment_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    close(descriptor);  // a mapping outlives its descriptor
    return static_cast<unsigned char*>(address);
  }
};

TEST_F(SegmentsTest, two_processes_see_the_same_bytes_at_different_addresses) {
  std::array<unsigned char*, 2> addresses{};
  std::array<int, 2> found{};
  const Outcome outcome = run([&](World& world) {
    world.allow_data_races();
    for (const int number : {0, 1}) {
      world.process(number == 0 ? "a" : "b").start("main", [&, number] {
        unsigned char* const bytes = open_and_map();
        addresses[number] = bytes;
        found[number] = bytes[7];
        bytes[7] = static_cast<unsigned char>(number + 1);
      });
    }
  });
  EXPECT_EQ(outcome, Outcome{});
  EXPECT_NE(addresses[0], addresses[1]);
  EXPECT_EQ(found, (std::array<int, 2>{0, 1}));  // fresh memory is zero; the second saw what the first wrote
}

TEST_F(SegmentsTest, memory_is_zero_again_in_the_next_execution) {
  const Outcome outcome = run_randomly(20, [](World& world) {
    world.process("a").start("main", [&world] {
      unsigned char* const bytes = open_and_map();
      for (std::size_t i = 0; i < segment_bytes; ++i) world.require(bytes[i] == 0, "fresh memory is zero");
      std::memset(bytes, 0xff, segment_bytes);
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SegmentsTest, the_calls_report_what_posix_says) {
  const Outcome outcome = run([](World& world) {
    world.process("a").start("main", [&world] {
      world.require(shm_open("/none", O_RDWR, 0600) == -1 && errno == ENOENT, "no such object");
      const int descriptor = shm_open("/s", O_CREAT | O_EXCL | O_RDWR, 0600);
      world.require(descriptor >= 0, "created");
      world.require(shm_open("/s", O_CREAT | O_EXCL | O_RDWR, 0600) == -1 && errno == EEXIST, "exists");
      world.require(ftruncate(descriptor, -1) == -1 && errno == EINVAL, "negative size");
      world.require(ftruncate(descriptor, 5000) == 0, "resized");
      struct stat status{};
      world.require(fstat(descriptor, &status) == 0 && status.st_size == 5000, "size");
      world.require(mmap(nullptr, 0, PROT_READ, MAP_SHARED, descriptor, 0) == MAP_FAILED && errno == EINVAL,
                    "no bytes");
      world.require(shm_unlink("/s") == 0, "unlinked");
      world.require(shm_unlink("/s") == -1 && errno == ENOENT, "unlinked once");
      world.require(shm_open("/s", O_RDWR, 0600) == -1 && errno == ENOENT, "the name is gone");
      world.require(fstat(descriptor, &status) == 0 && status.st_nlink == 0, "the object is not");
      world.require(close(descriptor) == 0, "closed");
      world.require(close(descriptor) == -1 && errno == EBADF, "closed once");
      world.require(ftruncate(descriptor, 1) == -1 && errno == EBADF, "closed descriptors are refused");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SegmentsTest, access_after_munmap_is_a_crash) {
  const Outcome outcome = run([](World& world) {
    world.process("a").start("main", [] {
      unsigned char* const bytes = open_and_map();
      munmap(bytes, segment_bytes);
      bytes[3] = 1;
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::crash);
  EXPECT_NE(outcome.message.find("byte 3 of segment segment"), std::string::npos) << outcome.message;
}

TEST_F(SegmentsTest, access_behind_the_last_page_is_a_crash) {
  const Outcome outcome = run([](World& world) {
    world.process("a").start("main", [] {
      unsigned char* const bytes = open_and_map();
      bytes[4095] = 1;  // within the page, as on Linux
      bytes[4096] = 1;
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::crash);
  EXPECT_NE(outcome.message.find("byte 4096"), std::string::npos) << outcome.message;
}

// A copy of 16 bytes between a segment and private memory may be seen half done.
TEST_F(SegmentsTest, a_copy_within_a_segment_can_be_torn) {
  const Outcome outcome = run_randomly(300, [](World& world) {
    world.allow_data_races();
    world.process("a").start("main", [] {
      std::array<unsigned char, 16> source{};
      source.fill(1);
      std::memcpy(open_and_map(), source.data(), source.size());
    });
    world.process("b").start("main", [&world] {
      std::array<unsigned char, 16> seen{};
      const unsigned char* const bytes = open_and_map();
      std::memcpy(seen.data(), bytes, seen.size());
      world.require(seen[0] == seen[15], "half old, half new");
    });
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "half old, half new"}));
}

TEST_F(SegmentsTest, overlapping_moves_and_fills_give_the_right_bytes) {
  const Outcome outcome = run([](World& world) {
    world.process("a").start("main", [&world] {
      unsigned char* const bytes = open_and_map();
      for (unsigned char i = 0; i < 40; ++i) bytes[i] = i;
      std::memmove(bytes + 5, bytes, 30);
      for (unsigned char i = 0; i < 30; ++i) world.require(bytes[5 + i] == i, "moved upward");
      std::memmove(bytes, bytes + 5, 30);
      for (unsigned char i = 0; i < 30; ++i) world.require(bytes[i] == i, "moved downward");
      std::memset(bytes + 1, 9, 19);
      world.require(bytes[0] == 0 && bytes[1] == 9 && bytes[19] == 9 && bytes[20] == 20, "filled");
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SegmentsTest, an_unlocked_increment_across_processes_loses_updates) {
  const Outcome outcome = run_randomly(100, [](World& world) {
    world.allow_data_races();
    const auto finished = std::make_shared<int>(0);
    for (const char* name : {"a", "b"}) {
      world.process(name).start("main", [&world, finished] {
        auto* const counter = reinterpret_cast<int*>(open_and_map());
        *counter = *counter + 1;
        if (++*finished == 2) world.require(*counter == 2, "an increment was lost");
      });
    }
  });
  EXPECT_EQ(outcome, (Outcome{OutcomeKind::invariant, "an increment was lost"}));
}

TEST_F(SegmentsTest, a_pointer_of_another_process_is_a_crash) {
  const Outcome outcome = run([](World& world) {
    const auto pointer = std::make_shared<unsigned char*>(nullptr);
    world.process("a").start("main", [pointer] { *pointer = open_and_map(); });
    world.process("b").start("main", [pointer] {
      open_and_map();
      **pointer = 1;
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::crash) << outcome.message;
}

TEST_F(SegmentsTest, a_write_to_a_mapping_for_reading_is_a_crash_and_a_read_is_not) {
  for (const bool write : {false, true}) {
    const Outcome outcome = run([write](World& world) {
      world.process("a").start("main", [write, &world] {
        open_and_map()[0] = 5;
        const int descriptor = shm_open("/segment", O_RDONLY, 0600);
        world.require(
            mmap(nullptr, segment_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0) == MAP_FAILED &&
                errno == EACCES,
            "no writing through a descriptor for reading");
        auto* const bytes =
            static_cast<unsigned char*>(mmap(nullptr, segment_bytes, PROT_READ, MAP_SHARED, descriptor, 0));
        world.require(bytes[0] == 5, "reading");
        if (write) bytes[0] = 1;
      });
    });
    EXPECT_EQ(outcome.kind, write ? OutcomeKind::crash : OutcomeKind::passed) << outcome.message;
  }
}

// The store is announced, then another task unmaps, then it happens.
TEST_F(SegmentsTest, a_mapping_that_goes_while_a_store_is_under_way_is_a_crash) {
  const Outcome outcome = run_randomly(300, [](World& world) {
    const auto bytes = std::make_shared<std::atomic<unsigned char*>>(nullptr);
    world.process("a").start("writer", [bytes] {
      *bytes = open_and_map();
      *bytes->load() = 1;
    });
    world.process("a").start("unmapper", [bytes] {
      while (bytes->load() == nullptr) sched_yield();
      munmap(bytes->load(), segment_bytes);
    });
  });
  EXPECT_EQ(outcome.kind, OutcomeKind::crash) << outcome.message;
}

TEST_F(SegmentsTest, the_rest_of_the_last_page_is_fresh_in_each_execution_too) {
  const Outcome outcome = run_randomly(3, [](World& world) {
    world.process("a").start("main", [&world] {
      unsigned char* const bytes = open_and_map();
      world.require(bytes[segment_bytes + 50] == 0, "fresh");
      bytes[segment_bytes + 50] = 7;
    });
  });
  EXPECT_EQ(outcome, Outcome{});
}

TEST_F(SegmentsTest,
       the_rest_of_the_last_page_is_fresh_after_a_longer_segment_and_after_executions_without_checks) {
  std::size_t written_before = 0;
  for (unsigned execution = 0; execution < 16; ++execution) {
    world().set_checks((execution / 2) % 2 == 0);  // on, on, off, off ...
    const bool is_long = execution % 2 == 1;       // ... and each way between a short one and a long one
    const std::size_t written = segment_bytes + (execution * 1009) % 3000;
    const Outcome outcome = run([=](World& world) {
      world.process("a").start("main", [=, &world] {
        unsigned char* const bytes = open_and_map();
        if (is_long && ftruncate(shm_open("/segment", O_RDWR, 0600), 4096) != 0) return;
        world.require(bytes[written_before] == 0, "fresh");
        bytes[written] = 7;
      });
    });
    written_before = written;
    EXPECT_EQ(outcome, Outcome{}) << execution;
  }
  world().set_checks(true);
}

}  // namespace
}  // namespace ltsim
