// Properties that do not hold, so that a test can see what a failure prints.

#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

PROPERTY(FailsOnPurpose, no_bytes_hold_a_stx, (const std::string& text)) {
  std::string bytes = text;
  if (text.size() > 5) bytes.insert(5, "\x02\x30");
  const FuzzInput input{"fx-frame", {bytes.substr(0, 3), bytes.size() < 3 ? "" : bytes.substr(3)}};
  RC_ASSERT(bytes.find('\x02') == std::string::npos);
}

PROPERTY(FailsOnPurpose, no_number_is_above_9, (unsigned number)) { RC_ASSERT(number <= 9U); }

}  // namespace
}  // namespace property_tests
