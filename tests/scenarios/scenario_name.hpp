// Tests that run over scenarios go by the scenarios' names, as far as GoogleTest allows them.
#pragma once

#include <cctype>
#include <string>

#include <gtest/gtest.h>

namespace scenarios {

/// "paper/time-out" as "paper_time_out".
inline std::string test_name(const testing::TestParamInfo<const char*>& tested) {
  std::string name = tested.param;
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

}  // namespace scenarios
