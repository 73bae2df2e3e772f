// World::written_first(): bytes that nobody may read before somebody has written them.

#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <thread>

#include "tests/sim_clock/calls_fixture.hpp"

namespace ltsim {
namespace {

class WrittenFirstTest : public CallsTest {
 protected:
  /// Two processes work on a segment whose bytes 8 to 15 are to be written first; the second begins 1 ms later.
  static Outcome run_on_segment(
      const std::function<void(char*)>& first, const std::function<void(char*)>& second = [](char*) {}) {
    return run([&](World& world) {
      world.written_first("segment", 8, 8, "segment.request");
      world.allow_data_races();
      world.process("one").start("main", [&] { first(static_cast<char*>(map_segment())); });
      world.process("two").start("main", [&] {
        std::this_thread::sleep_for(1ms);
        second(static_cast<char*>(map_segment()));
      });
    });
  }

  static Outcome read_too_soon(std::size_t byte, std::string_view task) {
    return {OutcomeKind::invariant, "byte " + std::to_string(byte) + " of segment.request is read by " +
                                        std::string{task} + " before anybody has written it"};
  }
};

std::atomic<std::uint32_t>& word_at(char* segment, std::size_t offset) {
  return *reinterpret_cast<std::atomic<std::uint32_t>*>(segment + offset);
}

TEST_F(WrittenFirstTest, zeros_of_a_new_segment_are_not_written) {
  EXPECT_EQ(run_on_segment([](char* segment) { static_cast<void>(word_at(segment, 8).load()); }),
            read_too_soon(0, "one/main"));
}

TEST_F(WrittenFirstTest, what_another_process_has_written_may_be_read) {
  EXPECT_EQ(run_on_segment([](char* segment) { word_at(segment, 12).store(7); },
                           [](char* segment) { static_cast<void>(word_at(segment, 12).load()); }),
            Outcome{});
}

TEST_F(WrittenFirstTest, each_byte_counts) {
  EXPECT_EQ(run_on_segment([](char* segment) { *static_cast<volatile char*>(segment + 9) = 1; },
                           [](char* segment) {
                             static_cast<void>(*static_cast<volatile char*>(segment + 9));
                             static_cast<void>(*static_cast<volatile char*>(segment + 10));
                           }),
            read_too_soon(2, "two/main"));
}

TEST_F(WrittenFirstTest, an_atomic_update_reads) {
  EXPECT_EQ(run_on_segment([](char* segment) { ++word_at(segment, 12); }), read_too_soon(4, "one/main"));
}

TEST_F(WrittenFirstTest, a_copy_reads_and_writes) {
  EXPECT_EQ(run_on_segment([](char* segment) { std::memcpy(segment + 8, "1234", 4); },
                           [](char* segment) {
                             std::array<char, 5> copy{};
                             std::memcpy(copy.data(), segment + 8, copy.size());
                           }),
            read_too_soon(4, "two/main"));
}

TEST_F(WrittenFirstTest, what_lies_beside_the_region_does_not_count) {
  EXPECT_EQ(run_on_segment([](char* segment) {
              static_cast<void>(word_at(segment, 4).load());
              static_cast<void>(word_at(segment, 16).load());
            }),
            Outcome{});
}

TEST_F(WrittenFirstTest, what_a_former_life_has_left_is_not_written) {
  EXPECT_EQ(run([](World& world) {
              constexpr std::array<std::byte, 16> content{};
              world.leave_segment("segment", content);
              world.written_first("segment", 8, 8, "segment.request");
              world.process("p").start(
                  "main", [] { static_cast<void>(word_at(static_cast<char*>(map_segment()), 8).load()); });
            }),
            read_too_soon(0, "p/main"));
}

TEST_F(WrittenFirstTest, an_empty_region_is_refused) {
  EXPECT_EQ(run([](World& world) { world.written_first("segment", 0, 0, "x"); }).kind,
            OutcomeKind::unsupported);
}

}  // namespace
}  // namespace ltsim
