// The arrows between the top-level folders, read from the includes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace house {

struct ForbiddenInclude {
  std::filesystem::path file;  ///< relative to the root
  std::size_t line = 0;        ///< 1 = the first
  std::string folder;          ///< the top-level folder that the file must not know

  bool operator==(const ForbiddenInclude&) const = default;
};

/// "protocol/a.hpp:12: includes sim_clock"
[[nodiscard]] std::string to_string(const ForbiddenInclude& found);

/// Every include below `root` that breaks a "never" of the design: sim_clock knows nothing of PLCs, the PLC
/// side knows nothing of simulation, protocol knows neither of its users, emulator and kernel do not know
/// each other, and none of them knows the tests.
///
/// An include counts by where it leads, read from the root as well as from the including file's folder, in
/// quotes or angle brackets, with or without "..", whether the file it names exists or not.
/// @return in order of file and line
[[nodiscard]] std::vector<ForbiddenInclude> forbidden_includes(const std::filesystem::path& root);

}  // namespace house
