// A history in words, for the message of an execution whose history is not linearizable.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace ltsim {

struct HistoryLine {
  std::string task;
  std::string text;  ///< operation and result
  std::uint32_t called_at = 0;
  std::uint32_t returned_at = 0;  ///< OperationInterval::never: it has not
};

/// One line an operation, in the order of their calls: when it was called and returned, by whom, what. Events
/// are numbered anew from 1, so that the same failure reads the same whatever went before. Of a long history
/// only the end is shown: at most 20 operations.
[[nodiscard]] std::string history_text(std::span<const HistoryLine> lines);

/// Name of the task that runs, "scenario" outside of any.
[[nodiscard]] std::string running_task_name();

}  // namespace ltsim
