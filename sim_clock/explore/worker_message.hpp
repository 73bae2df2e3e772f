// What a worker sends to its parent, at once when it happens, so that it outlives the worker.
//
// On the pipe each message is a 32-bit length in the host's byte order and so many bytes of CBOR. A worker that
// dies while it writes leaves a part of a message behind: such a part is ignored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "sim_clock/explore/explorer.hpp"

namespace ltsim {

/// A failure was found; or it is told again, because it has been made smaller.
struct WorkerFoundFailure {
  std::size_t place = 0;  ///< as records name it; what was told of that place before is replaced
  Failure failure;
};
/// The worker cannot go on: the code under test does what the world cannot simulate, or the fault is ours.
struct WorkerGaveUp {
  std::uint64_t execution = 0;
  std::string message;
};
/// The worker has run all that it was to run.
struct WorkerFinished {};

using WorkerMessage = std::variant<WorkerFoundFailure, WorkerGaveUp, WorkerFinished>;

/// @return the bytes for the pipe, length included
[[nodiscard]] std::vector<std::uint8_t> encode(const WorkerMessage& message);

/// Puts messages together again, from whatever pieces the pipe delivers.
class WorkerMessageReader {
 public:
  void add(std::span<const std::uint8_t> bytes) { buffer_.insert(buffer_.end(), bytes.begin(), bytes.end()); }
  /// @return the next whole message, if it has arrived
  /// @throw  std::exception if it is none of ours
  [[nodiscard]] std::optional<WorkerMessage> next();

 private:
  std::vector<std::uint8_t> buffer_;
};

}  // namespace ltsim
