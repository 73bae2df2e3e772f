// What a worker sends to its parent, at once when it happens, so that it outlives the worker.
//
// Each message is CBOR, in a frame of its own (frames.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "sim_clock/explore/explorer.hpp"
#include "sim_clock/explore/frames.hpp"

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

/// @return the bytes of the frame
[[nodiscard]] std::vector<std::uint8_t> encode(const WorkerMessage& message);

/// Puts messages together again, from whatever pieces arrive.
class WorkerMessageReader {
 public:
  void add(std::span<const std::uint8_t> bytes) { frames_.add(bytes); }
  /// @return the next whole message, if it has arrived
  /// @throw  std::exception if it is none of ours
  [[nodiscard]] std::optional<WorkerMessage> next();

 private:
  FrameReader frames_;
};

}  // namespace ltsim
