#include "tests/house/command_output.hpp"

#include <array>
#include <cstdio>

namespace house {

std::optional<std::string> output_of(const std::string& command) {
  std::FILE* const pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string output;
  std::array<char, 4096> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe))
    output.append(part.data(), count);
  if (::pclose(pipe) != 0) return std::nullopt;
  return output;
}

}  // namespace house
