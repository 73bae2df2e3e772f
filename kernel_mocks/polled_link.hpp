// The port in the hands of one auxiliary thread, as PC-to-PLC programs do it.
//
// The thread polls the status byte at a fixed interval and carries out queued requests, oldest first, between
// two polls. status() never touches the line: it hands out the last one with the time at which it was read.
// Other calls wait for their own request, and no longer than call_timeout.
//
// Invariants
//   - A request is carried out once or not at all; one that was given up before its turn is not carried out.
//   - One that is given up while it is on the line may have been carried out: write_timed_out says just that.
//   - The destructor lets the exchange under way end, answers what is queued with write_timed_out, and joins.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <thread>
#include <vector>

#include "kernel_mocks/plc_link.hpp"

namespace kernel_mocks {

struct PolledLinkOptions {
  std::chrono::nanoseconds poll_interval = std::chrono::milliseconds{5};
  std::chrono::nanoseconds call_timeout = std::chrono::seconds{1};
};

class PolledLink final : public PlcLink {
 public:
  /// @param driver  connected; used by nobody else while the link lives
  PolledLink(FxDriver& driver, const PolledLinkOptions& options);
  PolledLink(const PolledLink&) = delete;
  PolledLink& operator=(const PolledLink&) = delete;
  ~PolledLink();

  /// @return the last status, whatever its age; no_answer when none was read within call_timeout of the start;
  ///         the error of the last poll when it failed
  tl::expected<Status, FxDriverError> status() noexcept override;
  Done read_bytes(Device first, std::span<std::byte> into) noexcept override;
  Done write_bytes(Device first, std::span<const std::byte> bytes) noexcept override;
  Done force(Device device, bool on) noexcept override;

 private:
  enum class Kind : std::uint8_t { read, write, force };
  struct Request {
    Kind kind;
    Device device;
    bool on;
    /// What is written; of a read, what was read.
    std::vector<std::byte> bytes;
    bool begun = false;
    bool done = false;
    Done result{};
  };

  Done carry_out(const std::shared_ptr<Request>& request) noexcept;
  void run() noexcept;
  void execute(Request& request) noexcept;

  FxDriver& driver_;
  PolledLinkOptions options_;
  std::mutex mutex_;
  std::condition_variable work_;      ///< the thread waits here
  std::condition_variable finished_;  ///< the callers wait here
  std::deque<std::shared_ptr<Request>> queue_;
  bool stopping_ = false;
  bool polled_ = false;
  tl::expected<Status, FxDriverError> last_{tl::unexpected{FxDriverError::no_answer}};
  std::thread thread_;
};

}  // namespace kernel_mocks
