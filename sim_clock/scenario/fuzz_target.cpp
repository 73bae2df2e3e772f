#include "sim_clock/scenario/fuzz_target.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace ltsim {
namespace {

std::vector<FuzzTarget>& registry() {
  static std::vector<FuzzTarget> all;
  return all;
}

}  // namespace

std::vector<std::string_view> lines_as_records(std::string_view input) {
  std::vector<std::string_view> records;
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size() - 1) + 1;
    records.push_back(input.substr(0, end));
    input.remove_prefix(end);
  }
  return records;
}

std::vector<std::string_view> FuzzTarget::records(std::string_view input) const {
  return format.split == nullptr ? lines_as_records(input) : format.split(input);
}

const std::vector<FuzzTarget>& fuzz_targets() { return registry(); }

const FuzzTarget* find_fuzz_target(std::string_view name) {
  const auto found = std::ranges::find(registry(), name, &FuzzTarget::name);
  return found == registry().end() ? nullptr : &*found;
}

FuzzTargetRegistration::FuzzTargetRegistration(std::string_view name, const InputFormat& format,
                                               std::string_view description,
                                               void (*run)(std::span<const std::byte> input),
                                               const FuzzedScenario& scenario) {
  auto& all = registry();
  const auto place = std::ranges::lower_bound(all, name, {}, &FuzzTarget::name);
  if (place != all.end() && place->name == name) {
    std::fprintf(stderr, "two fuzz targets are called %.*s\n", static_cast<int>(name.size()), name.data());
    std::exit(2);
  }
  all.insert(
      place,
      FuzzTarget{
          .name = name, .description = description, .format = format, .run = run, .scenario = scenario});
}

}  // namespace ltsim
