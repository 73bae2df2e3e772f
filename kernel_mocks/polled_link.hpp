// The port in the hands of one auxiliary thread, as PC-to-PLC programs do it.
//
// The thread polls the status byte at a fixed interval and carries out requests, oldest first, between two polls.
// status() never touches the line: it hands out the last one with the time at which it was read. Other calls wait
// for their own request, and no longer than call_timeout.
//
// Invariants
//   - A request is carried out once or not at all; one that was given up before its turn is not carried out.
//   - One that is given up while it is on the line may have been carried out: write_timed_out says just that.
//   - Requests are carried out in the order in which they were made.
//   - The destructor lets the exchange under way end, answers what waits with write_timed_out, and returns when the
//     last caller has left.
// Requests live in requests_max slots, so no call allocates. A caller that finds none waits for one.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <thread>

#include "kernel_mocks/plc_link.hpp"

namespace kernel_mocks {

struct PolledLinkOptions {
  std::chrono::nanoseconds poll_interval = std::chrono::milliseconds{5};
  std::chrono::nanoseconds call_timeout = std::chrono::seconds{1};
};

class PolledLink final : public PlcLink {
 public:
  /// Waiting at once. The kernel has two threads that use the link, and a display may be a third.
  static constexpr std::size_t requests_max = 4;

  /// @param driver  connected; used by nobody else while the link lives
  PolledLink(FxDriver& driver, const PolledLinkOptions& options);
  PolledLink(const PolledLink&) = delete;
  PolledLink& operator=(const PolledLink&) = delete;
  ~PolledLink();

  /// @return the last status, whatever its age; no_answer when none was read within call_timeout of the start;
  ///         the error of the last poll when it failed
  tl::expected<Status, FxDriverError> status() noexcept override;
  /// These three: write_timed_out when the request was not done within call_timeout.
  Done read_bytes(Device first, std::span<std::byte> into) noexcept override;
  Done write_bytes(Device first, std::span<const std::byte> bytes) noexcept override;
  Done force(Device device, bool on) noexcept override;

 private:
  enum class Kind : std::uint8_t { read, write, force };
  struct Order {
    Kind kind = Kind::force;
    Device device{};
    bool on = false;
    std::size_t count = 0;
    /// What is written; of a read, what was read.
    std::array<std::byte, protocol::fx::data_bytes_max_wide> bytes{};
  };
  enum class State : std::uint8_t { free, waiting, on_the_line, done, given_up };
  struct Slot {
    State state = State::free;
    std::uint64_t turn = 0;
    Order order;
    Done result{};
  };

  /// @param order  of a read, holds what was read when the call succeeds
  Done carry_out(Order& order) noexcept;
  [[nodiscard]] Slot* free_slot() noexcept;
  [[nodiscard]] Slot* next_in_turn() noexcept;
  void run() noexcept;
  void poll(std::unique_lock<std::mutex>& lock) noexcept;
  Done exchange(Order& order) noexcept;

  FxDriver& driver_;
  PolledLinkOptions options_;
  std::mutex mutex_;
  std::condition_variable work_;     ///< the thread waits here
  std::condition_variable changed_;  ///< the callers wait here, and the destructor for them
  std::array<Slot, requests_max> slots_;
  std::uint64_t last_turn_ = 0;
  unsigned callers_ = 0;
  bool stopping_ = false;
  bool polled_ = false;
  tl::expected<Status, FxDriverError> last_{tl::unexpected{FxDriverError::no_answer}};
  std::thread thread_;
};

}  // namespace kernel_mocks
