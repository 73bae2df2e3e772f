// The protocol is production code: its libraries neither define nor need a symbol of the simulated world.

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/house/command_output.hpp"

namespace house {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// @param symbols  as nm -C prints them
/// @return the lines that name the namespace of sim_clock or a function that it takes over
std::vector<std::string> symbols_of_the_simulated_world(const std::string& symbols) {
  std::vector<std::string> found;
  std::istringstream lines(symbols);
  for (std::string line; std::getline(lines, line);)
    if (line.find("ltsim::") != std::string::npos || line.find("__tsan_") != std::string::npos)
      found.push_back(line);
  return found;
}

class ProtocolLibrary : public testing::TestWithParam<const char*> {};

TEST_P(ProtocolLibrary, has_no_symbol_of_the_simulated_world) {
  const auto symbols = output_of(std::string("nm -C '") + GetParam() + "'");
  ASSERT_TRUE(symbols) << "nm failed on " << GetParam();
  ASSERT_NE(symbols->find(" T protocol::"), std::string::npos) << "nm shows no symbols";
  EXPECT_THAT(symbols_of_the_simulated_world(*symbols), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Libraries, ProtocolLibrary,
                         testing::Values(LTSIM_PROTOCOL_LIBRARY, LTSIM_FX_LIBRARY));

TEST(SymbolsOfTheSimulatedWorld, are_found_whether_defined_or_needed) {
  EXPECT_THAT(symbols_of_the_simulated_world("0000000000000000 T protocol::to_string(protocol::PortError)\n"
                                             "                 U __tsan_read4\n"
                                             "0000000000000010 T ltsim::World::now()\n"),
              ElementsAre("                 U __tsan_read4", "0000000000000010 T ltsim::World::now()"));
}

}  // namespace
}  // namespace house
