// PROPERTY(): what must hold for every input, tried by RapidCheck on generated ones, as a case of GoogleTest.
//
//     PROPERTY(FxFrame, what_was_encoded_decodes_to_itself, ()) {
//       const Request sent = *any_request();
//       RC_ASSERT(decode_request(as_span(encode(sent))) == sent);
//     }
//
// Instead of RC_GTEST_PROP: the seed is fixed, so that a run is the same everywhere, and a counterexample comes with lines
// to paste. RC_PARAMS is RapidCheck's: RC_PARAMS="seed=7 max_success=100000" looks further.
//
// Where the input is the bytes of a fuzz target, FuzzInput makes a schedule file of the counterexample, too.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace property_tests {

struct TargetInput {
  std::string target;
  std::vector<std::string> records;
};

/// Says that what follows, to the end of the block, is about these bytes: of the smallest counterexample they become
/// out/property-SUITE.NAME.schedule.
class FuzzInput {
 public:
  /// @param target   name of a FUZZ_TARGET()
  /// @param records  together they are its input
  FuzzInput(std::string_view target, std::vector<std::string> records);
  ~FuzzInput();
  FuzzInput(const FuzzInput&) = delete;
  FuzzInput& operator=(const FuzzInput&) = delete;

  void add(std::string record) { input_.records.push_back(std::move(record)); }

 private:
  TargetInput input_;
  int exceptions_before_;
};

/// Fails the test under way unless the property holds.
void check(const rc::detail::Property& property);

}  // namespace property_tests

#define PROPERTY(suite, name, arguments)                                                                   \
  static void ltsim_property_##suite##_##name arguments;                                                   \
  TEST(suite, name) { ::property_tests::check(rc::detail::toProperty(&ltsim_property_##suite##_##name)); } \
  static void ltsim_property_##suite##_##name arguments
