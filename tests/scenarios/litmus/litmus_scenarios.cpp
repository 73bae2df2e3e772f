// Each litmus test as a scenario, "litmus/SB/release-acquire", that fails when the result that it is about is seen. Each task is a
// process of its own; the words lie in a segment that all of them map.
#include <fcntl.h>
#include <sys/mman.h>

#include <cstddef>
#include <deque>
#include <string>

#include <fmt/format.h>

#include "sim_clock/scenario/scenario.hpp"
#include "tests/scenarios/litmus/litmus_table.hpp"
#include "tests/scenarios/litmus/small_program.hpp"

namespace {

constexpr const char* segment = "litmus";

litmus::Words& map_words() {
  const int descriptor = shm_open(segment, O_RDWR, 0);
  return *static_cast<litmus::Words*>(
      mmap(nullptr, sizeof(litmus::Words), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0));
}

void run_variant(ltsim::World& world, const litmus::Program& program, const litmus::Variant& variant) {
  constexpr std::uint32_t word_bytes = sizeof(std::uint32_t);
  for (std::uint32_t word = 0; word < litmus::words_count; ++word)
    world.name_region(segment, word * word_bytes, word_bytes, fmt::format("{}.{}", segment, "xyz"[word]));
  const std::array<std::byte, sizeof(litmus::Words)> zeros{};
  world.leave_segment(segment, zeros);

  litmus::Result result;
  for (const litmus::Task& task : program) result.read.resize(result.read.size() + litmus::reads_count(task));
  std::uint32_t* read = result.read.data();
  const litmus::Words* mapped = nullptr;
  for (std::size_t i = 0; i < program.size(); ++i) {
    const litmus::Task& task = program[i];
    world.process(fmt::format("P{}", i)).start("main", [&task, &mapped, read] {
      litmus::Words& words = map_words();
      mapped = &words;
      litmus::run(task, words, read);
    });
    read += litmus::reads_count(task);
  }
  world.run();
  if (world.failed()) return;
  for (std::size_t word = 0; word < litmus::words_count; ++word)
    result.words[word] = (*mapped)[word].load(std::memory_order_relaxed);
  world.require(!litmus::matches(result, variant.result),
                fmt::format("{} came to {}", variant.program, to_string(result)));
}

/// Registers all variants before main().
struct Registration {
  Registration() {
    for (const litmus::Variant& variant : litmus::variants()) {
      const std::string& name = names.emplace_back(fmt::format("litmus/{}", variant.name));
      const std::string& description = names.emplace_back(
          fmt::format("{}: {}", variant.program,
                      variant.verdict == litmus::Verdict::forbidden ? "may not come to " : "may come to ") +
          std::string{variant.result});
      const ltsim::ScenarioRegistration registered{
          name, description, [program = litmus::parse(variant.program), &variant](ltsim::World& world) {
            run_variant(world, program, variant);
          }};
      static_cast<void>(registered);
    }
  }

  std::deque<std::string> names;  // a registered name is a view
};
const Registration registration;

}  // namespace
