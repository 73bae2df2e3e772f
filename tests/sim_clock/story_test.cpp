#include "sim_clock/trace/story.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include <gtest/gtest.h>

#include "sim_clock/explore/explorer.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

int* map_counter() {
  const int descriptor = shm_open("/parts", O_CREAT | O_RDWR, 0600);
  if (ftruncate(descriptor, 4096) != 0) return nullptr;
  return static_cast<int*>(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
}

void counts_parts(World& world) {
  world.name_region("parts", 0, sizeof(int), "parts.count");
  const auto finished = std::make_shared<int>(0);
  for (const char* name : {"lathe", "mill"}) {
    world.process(name).start("main", [finished, &world] {
      std::atomic_ref<int> count{*map_counter()};
      count = count + 1;
      world.note([] { return std::string{"one more"}; });
      if (++*finished == 2) world.require(count == 2, "a part was not counted");
    });
  }
  world.run();
}

void hands_over_many_bytes(World& world) {
  world.name_region("parts", 0, 16, "parts.order");
  world.process("sender").start("main", [] {
    int* const words = map_counter();
    for (int i = 0; i < 4; ++i) std::atomic_ref<int>{words[i]} = 10 + i;
    for (int i = 0; i < 200; ++i) std::atomic_ref<int>{words[4 + i % 2]} = i;
  });
  world.process("receiver").start("main", [&world] {
    int* const words = map_counter();
    int sum = 0;
    for (int i = 0; i < 4; ++i) sum += std::atomic_ref<int>{words[i]};
    world.require(sum != 46, "all four came");
  });
  world.run();
}

class StoryTest : public WorldTest {
 protected:
  static std::string story_of(void (*body)(World&), const Schedule& schedule) {
    Story story{world(), schedule};
    const ReplayReport report = Explorer{world()}.replay({"demo/story", "", body}, schedule, &story);
    EXPECT_FALSE(report.divergence);
    return story.text(report.outcome);
  }

  static Schedule switch_at(std::string anchor, std::string to_task) {
    Deviation line;
    line.anchor = std::move(anchor);
    line.to_task = std::move(to_task);
    Schedule schedule;
    schedule.deviations = {line};
    return schedule;
  }
};

TEST_F(StoryTest, tells_who_was_stopped_where_what_each_read_and_wrote_and_the_verdict) {
  EXPECT_EQ(story_of(&counts_parts, switch_at("lathe/main before atomic_store parts.count #1", "mill/main")),
            R"(  story: 5 of 11 steps
         0.400us  lathe/main         reads    parts.count = 0
      -> lathe/main is stopped before its atomic_store parts.count #1; mill/main runs
         0.900us  mill/main          reads    parts.count = 0
         1.000us  mill/main          writes   parts.count := 1
         1.000us                     one more
         1.000us  lathe/main         writes   parts.count := 1
         1.000us                     one more
         1.100us  lathe/main         reads    parts.count = 1
      => invariant: a part was not counted, at 1100ns
)");
}

TEST_F(StoryTest, bytes_in_a_row_are_one_line_and_what_another_task_wrote_is_said_so) {
  const std::string story = story_of(&hands_over_many_bytes, {});
  EXPECT_NE(story.find("writes   parts.order[0..12] := 10 11 12 13\n"), std::string::npos) << story;
  EXPECT_NE(story.find("reads    parts.order[0..12] = 10 11 12 13   (sender/main wrote that)\n"),
            std::string::npos)
      << story;
}

TEST_F(StoryTest, a_long_execution_still_fits_a_screen_and_keeps_what_matters) {
  const std::string story = story_of(&hands_over_many_bytes, {});
  EXPECT_LE(static_cast<std::size_t>(std::count(story.begin(), story.end(), '\n')), Story::lines_max);
  EXPECT_NE(story.find("(sender/main wrote that)"), std::string::npos) << story;
  EXPECT_TRUE(story.ends_with("=> invariant: all four came, at 21400ns\n")) << story;
}

}  // namespace
}  // namespace ltsim
