// A search in parts comes to what the search in one go does, however it is split.
#include "sim_clock/explore/search_tree.hpp"

#include <array>
#include <atomic>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sim_clock/explore/random_generator.hpp"
#include "sim_clock/explore/search_runner.hpp"
#include "tests/sim_clock/known_traces.hpp"
#include "tests/sim_clock/world_fixture.hpp"

namespace ltsim {
namespace {

using Word = std::atomic<std::uint32_t>;

std::string to_string(const SearchCounts& counts) {
  return fmt::format("{} executions, {} redundant, {} points", counts.executions, counts.redundant,
                     counts.points);
}

class SearchTreeTest : public WorldTest {
 protected:
  struct Result {
    SearchCounts counts;
    bool is_complete = false;
    std::string end;  // what the first part that failed has left, as text
  };

  static Result search_in_one_go(const std::function<void(World&)>& body, const ProveOptions& options = {}) {
    const Scenario scenario{.name = "test/tree", .description = "", .body = body};
    const SignalGuard signals;
    SearchRunner runner{world(), scenario, options};
    runner.warm_up();
    SearchTree tree;
    SearchTree::Part& part = *tree.take();
    tree.give_back(part, runner.search(SearchTree::item_of(part), [](const auto&) { return true; }), false);
    return result_of(tree);
  }

  /// As by several processes, which are at a part for some executions each, and are faster or slower.
  /// @param seed  of all that depends on time then
  static Result search_in_parts(const std::function<void(World&)>& body, std::uint64_t seed,
                                const ProveOptions& options = {}) {
    const Scenario scenario{.name = "test/tree", .description = "", .body = body};
    const SignalGuard signals;
    SearchRunner runner{world(), scenario, options};
    runner.warm_up();
    RandomGenerator chance{seed};
    const std::uint32_t processes = 1 + chance.below(5);
    SearchTree tree;
    std::vector<SearchTree::Part*> taken;
    for (;;) {
      // It can be interrupted at any time.
      if (chance.below(50) == 0 && !tree.is_complete()) {
        auto read = SearchTree::parse(tree.checkpoint());
        EXPECT_TRUE(read);
        EXPECT_EQ(read->checkpoint(), tree.checkpoint());
        tree = std::move(*read);
        taken.clear();
      }
      while (taken.size() < processes) {
        SearchTree::Part* const part = tree.take();
        if (part == nullptr) break;
        taken.push_back(part);
      }
      if (tree.is_over()) return result_of(tree);
      const auto which =
          taken.begin() + static_cast<std::ptrdiff_t>(chance.below(static_cast<std::uint32_t>(taken.size())));
      SearchTree::Part& part = **which;
      taken.erase(which);
      const auto item = parse_item(to_text(SearchTree::item_of(part)));
      EXPECT_TRUE(item);
      std::size_t executions = chance.below(4);
      const auto slice =
          parse_slice(to_text(runner.search(*item, [&](const SearchCounts&) { return executions-- > 0; })));
      EXPECT_TRUE(slice);
      tree.give_back(part, *slice, chance.below(4) != 0);
      EXPECT_LE(tree.done(), 1.0000001);
    }
  }

  static Result result_of(const SearchTree& tree) {
    Result result{.counts = tree.counts(), .is_complete = tree.is_complete(), .end = {}};
    if (const SearchTree::Part* const ended = tree.ended()) {
      for (const Decision& decision : SearchTree::item_of(*ended).decisions)
        result.end += fmt::format("{} ", decision.chosen);
    }
    return result;
  }

  static void expect_equal_results(const std::string& name, const std::function<void(World&)>& body,
                                   const ProveOptions& options, unsigned seeds) {
    const Result whole = search_in_one_go(body, options);
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Result parts = search_in_parts(body, seed, options);
      EXPECT_EQ(to_string(parts.counts), to_string(whole.counts)) << name << ", seed " << seed;
      EXPECT_EQ(parts.is_complete, whole.is_complete) << name << ", seed " << seed;
      EXPECT_EQ(parts.end, whole.end) << name << ", seed " << seed;
    }
  }
};

TEST_F(SearchTreeTest, counts_of_programs_with_known_traces_are_those_of_one_go) {
  for (const Known& known : known_programs()) {
    if (known.traces < 2000) expect_equal_results(known.name, known.body, {}, 4);
  }
}

/// Words that are read, written, added to and compared, so that it often depends on what came before whether an order matters.
void some_program(World& world, std::uint64_t seed, bool fails) {
  RandomGenerator plan{seed};
  std::array<Word, 2> words{};
  const std::size_t tasks = 3 + seed % 2;
  std::vector<std::vector<std::uint32_t>> steps(tasks, std::vector<std::uint32_t>(tasks == 3 ? 3 : 2));
  for (auto& task : steps) {
    for (std::uint32_t& step : task) step = plan.below(8);
  }
  start_tasks(world, static_cast<std::uint32_t>(tasks), [&](std::uint32_t i) {
    for (const std::uint32_t step : steps[i]) {
      Word& word = words[step % 2];
      std::uint32_t expected = 0;
      if (step / 2 == 0) word.compare_exchange_strong(expected, i + 1);
      if (step / 2 == 1) word.store(step + i);
      if (step / 2 == 2 && word.load() == i + 1) words[1 - step % 2].store(7);
      if (step / 2 == 3) word.fetch_add(1);
    }
  });
  world.run();
  world.require(!fails || words[0].load() + words[1].load() != 8, "eight");
}

TEST_F(SearchTreeTest, counts_of_random_programs_are_those_of_one_go) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    expect_equal_results(
        fmt::format("program {}", seed), [&](World& of) { some_program(of, seed, false); }, {}, 3);
  }
}

TEST_F(SearchTreeTest, the_first_failure_is_that_of_one_go) {
  unsigned failed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto body = [&](World& of) { some_program(of, seed, true); };
    failed += search_in_one_go(body).end.empty() ? 0U : 1U;
    expect_equal_results(fmt::format("program {}", seed), body, {}, 3);
  }
  EXPECT_GT(failed, 10U);
  EXPECT_LT(failed, 50U);
}

TEST_F(SearchTreeTest, counts_with_a_bound_on_preemptions_are_those_of_one_go) {
  ProveOptions options;
  options.bounds.preemptions = 2;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expect_equal_results(
        fmt::format("program {}", seed), [&](World& of) { some_program(of, seed, seed % 2 == 0); }, options,
        3);
  }
}

TEST_F(SearchTreeTest, numbers_that_are_asked_for_are_split_as_well) {
  expect_equal_results(
      "numbers",
      [](World& of) {
        const std::size_t first = of.choose("first", 5);
        Word word{0};
        start_tasks(of, 2, [&](std::uint32_t) {
          for (std::size_t i = 0; i < first; ++i) word.fetch_add(1);
        });
        of.run();
        of.require(of.choose("second", 3) < 3, "more than there are");
      },
      {}, 6);
}

TEST_F(SearchTreeTest, after_a_part_that_failed_none_is_searched_any_more) {
  SearchTree tree;
  SearchTree::Part& root = *tree.take();
  tree.give_back(root, {.rest = {{.count = 3}, {.count = 2}}}, true);
  SearchTree::Part& first = *tree.take();
  SearchTree::Part& second = *tree.take();
  SearchTree::Part& third = *tree.take();
  EXPECT_EQ(tree.take(), nullptr);
  tree.give_back(second, {.end = SliceEnd::failed, .counts = {.executions = 1}}, true);
  tree.give_back(third, {.counts = {.executions = 5}, .rest = {{.count = 2}}}, true);
  EXPECT_EQ(tree.take(), nullptr);
  EXPECT_FALSE(tree.is_over());
  tree.give_back(first, {.end = SliceEnd::over, .counts = {.executions = 2}}, true);
  EXPECT_EQ(tree.take(), nullptr);
  EXPECT_TRUE(tree.is_over());
  EXPECT_FALSE(tree.is_complete());
  EXPECT_EQ(tree.ended(), &second);
  EXPECT_EQ(tree.counts().executions, 3U);
}

TEST_F(SearchTreeTest, what_is_asked_for_waits_for_the_parts_before) {
  const Decision of_three{.is_of_tasks = true, .chosen = 0, .enabled = 0b1111};
  Decision decision = of_three;
  decision.must_try(0);
  decision.must_try(1);
  SearchTree tree;
  SearchTree::Part& root = *tree.take();
  tree.give_back(root, {.rest = {decision}}, true);
  SearchTree::Part& first = *tree.take();
  SearchTree::Part& second = *tree.take();
  EXPECT_EQ(SearchTree::item_of(second).decisions.front().tried, 0b0001U);
  // Both find one that must be tried; the search in one go finds that of the first part first.
  tree.give_back(second, {.end = SliceEnd::over, .requests = {{.decision = 0, .any = 0b0100}}}, true);
  EXPECT_EQ(tree.take(), nullptr);
  tree.give_back(first, {.end = SliceEnd::over, .requests = {{.decision = 0, .any = 0b1000}}}, true);
  const SearchTree::Part& third = *tree.take();
  EXPECT_EQ(SearchTree::item_of(third).decisions.front().chosen, 3U);
  EXPECT_EQ(SearchTree::item_of(third).decisions.front().tried, 0b0011U);
  const SearchTree::Part& fourth = *tree.take();
  EXPECT_EQ(SearchTree::item_of(fourth).decisions.front().chosen, 2U);
  EXPECT_EQ(SearchTree::item_of(fourth).decisions.front().tried, 0b1011U);
}

TEST_F(SearchTreeTest, of_a_text_that_is_none_nothing_is_read) {
  const std::string good = SearchTree{}.checkpoint();
  EXPECT_TRUE(SearchTree::parse(good));
  for (const std::string& bad :
       {std::string{}, std::string{"nonsense\n"}, good + "leaf 0\n", good.substr(0, good.find('\n') + 1),
        good.substr(0, good.find("leaf")) + "over\n"})
    EXPECT_FALSE(SearchTree::parse(bad)) << bad;
}

}  // namespace
}  // namespace ltsim
