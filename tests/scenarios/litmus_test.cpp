// The weak memory of the simulated world against the standard: by exhaustive search it shows every result that C++20 allows a
// program, except by load buffering, and no other.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim_clock/explore/prover.hpp"
#include "sim_clock/explore/random_generator.hpp"
#include "tests/scenarios/litmus/axioms.hpp"
#include "tests/scenarios/litmus/litmus_table.hpp"

namespace {

using litmus::Result;

ltsim::World& world() {
  static ltsim::World only;
  return only;
}

/// All results that the simulated memory shows.
std::set<Result> simulated(const litmus::Program& program, ltsim::Memory memory) {
  std::set<Result> results;
  std::size_t reads_count = 0;
  for (const litmus::Task& task : program) reads_count += litmus::reads_count(task);
  const ltsim::Scenario scenario{.name = "test/litmus", .description = "", .body = [&](ltsim::World& of) {
                                   litmus::Words words{};
                                   Result result;
                                   result.read.resize(reads_count);
                                   std::uint32_t* read = result.read.data();
                                   for (std::size_t i = 0; i < program.size(); ++i) {
                                     of.process("program").start(fmt::format("task-{}", i), [&, i, read] {
                                       litmus::run(program[i], words, read);
                                     });
                                     for (const litmus::Step& step : program[i])
                                       read += litmus::reads(step.kind) ? 1 : 0;
                                   }
                                   of.run();
                                   if (of.failed()) return;
                                   for (std::size_t i = 0; i < words.size(); ++i)
                                     result.words[i] = words[i].load(std::memory_order_relaxed);
                                   results.insert(result);
                                 }};
  ltsim::ProveOptions options;
  options.memory = memory;
  const ltsim::ProveReport report =
      ltsim::Prover{world()}.prove(scenario, options, {}, [](const ltsim::ProveReport&) { return true; });
  EXPECT_TRUE(report.complete);
  EXPECT_FALSE(report.error) << *report.error;
  return results;
}

std::string to_text(const std::set<Result>& results) {
  std::string text;
  for (const Result& result : results) text += "\n  " + to_string(result);
  return text;
}

class LitmusTest : public testing::TestWithParam<litmus::Variant> {};

TEST_P(LitmusTest, shows_what_the_standard_allows_and_nothing_else) {
  const litmus::Program program = litmus::parse(GetParam().program);
  const litmus::Allowed allowed = litmus::allowed_by_axioms(program);
  const auto has = [&](const std::set<Result>& results) {
    return std::any_of(results.begin(), results.end(),
                       [](const Result& result) { return litmus::matches(result, GetParam().result); });
  };
  // The table, by hand, against the axioms, by program.
  EXPECT_EQ(has(allowed.results), GetParam().verdict == litmus::Verdict::allowed);
  EXPECT_EQ(has(allowed.by_load_buffering), GetParam().verdict == litmus::Verdict::allowed_by_load_buffering);
  EXPECT_EQ(to_text(simulated(program, ltsim::Memory::c11)), to_text(allowed.results));
}

INSTANTIATE_TEST_SUITE_P(Litmus, LitmusTest,
                         testing::ValuesIn(litmus::variants().begin(), litmus::variants().end()),
                         [](const auto& variant) {
                           std::string name{variant.param.name};
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
                           return name;
                         });

TEST_P(LitmusTest, is_a_scenario_that_proves_it) {
  const ltsim::Scenario* const scenario = ltsim::find_scenario(fmt::format("litmus/{}", GetParam().name));
  ASSERT_NE(scenario, nullptr);
  ltsim::ProveOptions options;
  options.memory = ltsim::Memory::c11;
  const ltsim::ProveReport report =
      ltsim::Prover{world()}.prove(*scenario, options, {}, [](const ltsim::ProveReport&) { return true; });
  EXPECT_FALSE(report.error) << *report.error;
  EXPECT_EQ(report.failure.has_value(), GetParam().verdict == litmus::Verdict::allowed);
  EXPECT_NE(report.complete, report.failure.has_value());
}

litmus::Program random_program(ltsim::RandomGenerator& generator) {
  using enum std::memory_order;
  using Kind = litmus::Step::Kind;
  litmus::Program program(2 + generator.below(2));
  for (litmus::Task& task : program) {
    const std::uint32_t steps = 1 + generator.below(program.size() == 2 ? 4 : 3);
    for (std::uint32_t i = 0; i < steps; ++i) {
      litmus::Step step;
      step.word = generator.below(2);
      step.value = 1 + generator.below(2);
      step.expected = generator.below(2);
      const std::uint32_t drawn = generator.below(16);
      step.kind = drawn < 6    ? Kind::load
                  : drawn < 11 ? Kind::store
                  : drawn < 13 ? Kind::fence
                  : drawn < 15 ? Kind::add
                               : Kind::compare;
      const bool reads = litmus::reads(step.kind) || step.kind == Kind::fence;
      const bool writes = step.kind != Kind::load;
      std::vector<std::memory_order> orders{seq_cst};
      if (step.kind != Kind::fence) orders.push_back(relaxed);
      if (reads) orders.push_back(acquire);
      if (writes) orders.push_back(release);
      if (reads && writes) orders.push_back(acq_rel);
      step.order = orders[generator.below(static_cast<std::uint32_t>(orders.size()))];
      task.push_back(step);
    }
  }
  return program;
}

TEST(LitmusRandomTest, programs_show_what_the_standard_allows_and_nothing_else) {
  ltsim::RandomGenerator generator{20261130};
  for (int i = 0; i < 1000; ++i) {
    const litmus::Program program = random_program(generator);
    ASSERT_EQ(to_text(simulated(program, ltsim::Memory::c11)),
              to_text(litmus::allowed_by_axioms(program).results))
        << to_string(program);
  }
}

}  // namespace
