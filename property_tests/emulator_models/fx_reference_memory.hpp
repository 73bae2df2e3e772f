// An FX PLC at its programming port as the tables of the protocol have it: values by name, and one line a table row. Slow, and
// written without a look at the emulator.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/fx/address_map.hpp"
#include "protocol/fx/frame.hpp"

namespace property_tests {

struct FxReferenceMemory {
  using Name =
      std::pair<char, unsigned>;  ///< 'X' 'Y' 'M' 'S' 'D'; 't' 'c' contacts, 'T' 'C' values; a number

  explicit FxReferenceMemory(protocol::fx::Model fx_model);

  /// Does what the request asks for.
  /// @return the answer: ACK, NAK, or a frame of data
  std::string answer(const protocol::fx::Request& request);
  /// A frame came that says nothing; the PLC notes why.
  std::string refuse(unsigned trouble);

  protocol::fx::Model model;
  std::map<Name, unsigned> values;  ///< of those that are not 0
};

/// A stretch of addresses in which devices lie, of whatever model.
struct FxAddressRange {
  unsigned first;
  unsigned end;
};
[[nodiscard]] std::vector<FxAddressRange> fx_address_ranges(protocol::fx::Model model, bool wide);

}  // namespace property_tests
