#include "property_tests/support/property.hpp"

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "sim_clock/explore/schedule.hpp"

namespace property_tests {
namespace {

namespace fs = std::filesystem;
using namespace rc::detail;

constexpr std::uint64_t seed_default = 1;
constexpr int cases_default = 200;

/// Of the case under way, once it has been left by an exception.
std::optional<TargetInput> left_behind;

/// Keeps what the latest case that failed has left behind. RapidCheck goes on from a smaller case only if it fails as well, so in
/// the end that is the smallest counterexample.
class FailingInput final : public TestListener {
 public:
  void onTestCaseFinished(const CaseDescription& description) override {
    keep_if(description.result.type == CaseResult::Type::Failure);
  }
  void onShrinkTried(const CaseDescription& /*shrink*/, bool accepted) override { keep_if(accepted); }
  void onTestFinished(const TestMetadata& /*metadata*/, const TestResult& /*result*/) override {}

  std::optional<TargetInput> input;

 private:
  void keep_if(bool failed) {
    if (failed) input = left_behind;
    left_behind.reset();
  }
};

const Configuration& configuration_of_run() {
  static const Configuration configuration = [] {
    Configuration defaults;
    defaults.testParams.seed = seed_default;
    defaults.testParams.maxSuccess = cases_default;
    const char* const asked_for = std::getenv("RC_PARAMS");
    return configFromString(asked_for == nullptr ? "" : asked_for, defaults);
  }();
  return configuration;
}

/// As a shell takes it.
std::string this_program() { return fs::read_symlink("/proc/self/exe").string(); }

std::string line_to_repeat(const std::string& id, const Reproduce& reproduce) {
  Configuration only_that;
  only_that.reproduce.emplace(id, reproduce);
  return fmt::format("RC_PARAMS=\"{}\" {} --gtest_filter={}", configToMinimalString(only_that),
                     this_program(), id);
}

/// Writes the schedule. @return the line that runs it
std::string line_to_replay(const std::string& id, const TargetInput& input) {
  ltsim::Schedule schedule;
  schedule.scenario = "fuzz/" + input.target;
  schedule.input = input.records;
  schedule.outcome = ltsim::OutcomeKind::invariant;
  schedule.message = "property " + id;
  const fs::path file = fs::absolute("out") / fmt::format("property-{}.schedule", id);
  fs::create_directories(file.parent_path());
  std::ofstream{file, std::ios::binary} << to_string(schedule);
  // Without the simulated world there is no ltsim; the target's own program takes the file as well.
  const fs::path folder = fs::path{this_program()}.parent_path();
  if (!fs::exists(folder / "ltsim"))
    return fmt::format("{} {}", (folder / ("fuzz-" + input.target)).string(), file.string());
  return fmt::format("{} replay {}", (folder / "ltsim").string(), file.string());
}

}  // namespace

FuzzInput::FuzzInput(std::string_view target, std::vector<std::string> records)
    : input_{std::string{target}, std::move(records)}, exceptions_before_{std::uncaught_exceptions()} {}

FuzzInput::~FuzzInput() {
  if (std::uncaught_exceptions() > exceptions_before_) left_behind = std::move(input_);
}

void check(const Property& property) {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const std::string id = fmt::format("{}.{}", test.test_suite_name(), test.name());
  left_behind.reset();
  FailingInput failing;
  const Configuration& configuration = configuration_of_run();
  const TestResult result =
      checkProperty(property, {id, test.name()}, configuration.testParams, failing, configuration.reproduce);
  std::ostringstream text;
  printResultMessage(result, text);
  if (result.is<SuccessResult>()) {
    if (!result.get<SuccessResult>().distribution.empty()) std::cout << text.str() << std::endl;
    return;
  }
  if (result.is<FailureResult>()) {
    text << "\n\nagain:   " << line_to_repeat(id, result.get<FailureResult>().reproduce);
    // A counterexample that is run again has no listener.
    const auto& input = failing.input ? failing.input : left_behind;
    if (input) text << "\nreplay:  " << line_to_replay(id, *input);
  }
  ADD_FAILURE() << text.str();
}

}  // namespace property_tests
