#include "kernel_mocks/run_result.hpp"

#include <fmt/format.h>

namespace kernel_mocks {

std::string place_of(const Block& block) {
  return block.number ? fmt::format("block N{} (line {})", *block.number, block.line)
                      : fmt::format("line {}", block.line);
}

RunResult failed_at(const std::string& where, const LogicFailure& failure) {
  return {.outcome = RunOutcome::failed,
          .message = fmt::format("{}: {}", where, to_string(failure)),
          .failure = failure};
}

RunResult stopped_at(const std::string& where, const char* why) {
  return {.outcome = RunOutcome::stopped, .message = fmt::format("{}: {}", where, why), .failure = {}};
}

RunStep as_step(const std::string& where, const tl::expected<void, LogicFailure>& done) {
  if (!done) return tl::unexpected{failed_at(where, done.error())};
  return {};
}

}  // namespace kernel_mocks
