// The kernel's logic task: gives auxiliary functions to the PLC and waits until it has done them.
//
// One function request, one handshake of levels (fact base: Fanuc's M, S, T interface):
//
//   1. FIN is waited for to be off: a FIN that is still on belongs to something else.
//   2. Code, speed and tool number are written with one request.
//   3. The strobes of the request rise together, by one write of the byte that holds them. Bits forced one by
//      one could be seen by different scans, and the PLC could answer FIN to the first of them alone.
//   4. FIN is polled for. An alarm or a lost emergency-stop chain ends the wait.
//   5. The strobes fall; FIN is waited for to be off.
//
// Speed and tool number keep their value between requests, the PLC heeds them when their strobe rises; the
// M code means nothing without its strobe.
//
// TMF delays step 3; a FIN that falls before it has been on for TFIN does not count. A FIN shorter than the poll
// interval may be missed; the fin_timeout then ends the wait.
//
// The signals of the motion (DEN, feed hold, Z at the tool change position) are set through this class too, by
// another thread: DEN shares its byte with the strobes.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include <tl/expected.hpp>

#include "kernel_mocks/block_plan.hpp"
#include "kernel_mocks/logic_failure.hpp"
#include "kernel_mocks/plc_link.hpp"

namespace kernel_mocks {

enum class FunctionKind : std::uint8_t { m, s, t };

/// Told of every function of every request.
class LogicTaskObserver {
 public:
  virtual ~LogicTaskObserver() = default;

  /// The PLC has taken the write that raises the strobe of this function.
  virtual void strobe_raised(FunctionKind /*kind*/, std::uint16_t /*number*/) noexcept {}
  /// FIN was seen for this function.
  /// @param duration  from the strobe to FIN
  virtual void finished(FunctionKind /*kind*/, std::uint16_t /*number*/,
                        std::chrono::nanoseconds /*duration*/) noexcept {}

 protected:
  LogicTaskObserver() = default;
  LogicTaskObserver(const LogicTaskObserver&) = default;
  LogicTaskObserver& operator=(const LogicTaskObserver&) = default;
};

struct LogicTaskOptions {
  std::chrono::nanoseconds poll_interval = std::chrono::milliseconds{5};
  /// Longest wait for FIN to come, and for it to go.
  std::chrono::nanoseconds fin_timeout = std::chrono::seconds{10};
  /// Longest wait at the program start for the PLC to allow it.
  std::chrono::nanoseconds ready_timeout = std::chrono::seconds{2};
  /// From the code to its strobe (Fanuc's parameter 3010, 16 ms there). Zero: the code is acknowledged by the PLC
  /// before the strobe is sent, so that nothing has to settle.
  std::chrono::nanoseconds tmf{0};
  /// Shortest FIN that counts (Fanuc's parameter 3011, 16 ms there). Zero: a FIN seen by a poll has been on for a
  /// whole scan of the PLC.
  std::chrono::nanoseconds tfin{0};
  /// A status older than this is a lost link; only a link that polls by itself has old ones.
  std::chrono::nanoseconds status_age_max = std::chrono::seconds{1};
  /// Length of the reset signal: longer than a scan, so that no PLC misses it.
  std::chrono::nanoseconds reset_pulse = std::chrono::milliseconds{50};
};

class LogicTask {
 public:
  /// @param driver    connected; must outlive the task
  /// @param observer  may be nullptr
  /// @param stop      may be nullptr; when it becomes true, every wait ends with LogicFault::interrupted
  LogicTask(FxDriver& driver, const LogicTaskOptions& options, LogicTaskObserver* observer = nullptr,
            const std::atomic<bool>* stop = nullptr);
  /// @param link  must outlive the task
  LogicTask(PlcLink& link, const LogicTaskOptions& options, LogicTaskObserver* observer = nullptr,
            const std::atomic<bool>* stop = nullptr);

  /// Takes back what a former kernel may have left on, resets the PLC, and waits until it is ready: no alarm,
  /// emergency-stop chain closed, cycle start enabled. Then "program running" is on.
  [[nodiscard]] tl::expected<void, LogicFailure> begin_program();

  /// Steps 1 to 3. The request before must have been acknowledged.
  [[nodiscard]] tl::expected<void, LogicFailure> raise(const FunctionRequest& request);
  /// Steps 4 and 5 of the request raised last.
  /// @return time from the strobe to FIN
  [[nodiscard]] tl::expected<std::chrono::nanoseconds, LogicFailure> acknowledge();

  [[nodiscard]] tl::expected<void, LogicFailure> end_program();

  /// Ends every wait with LogicFault::interrupted, from any thread, until the next begin_program().
  void abort() noexcept { aborted_.store(true); }
  [[nodiscard]] bool interrupted() const noexcept;
  [[nodiscard]] const LogicTaskOptions& options() const noexcept { return options_; }
  [[nodiscard]] PlcLink& link() noexcept { return link_; }

  /// What a motion has to heed, read now.
  /// @return M120 to M127; or link_lost, emergency_stop, alarm
  [[nodiscard]] tl::expected<std::byte, LogicFailure> healthy_status();
  /// DEN: off while a motion of the block is under way. Any thread.
  [[nodiscard]] tl::expected<void, LogicFailure> set_motion_under_way(bool under_way);
  [[nodiscard]] tl::expected<void, LogicFailure> set_feed_hold(bool active);
  [[nodiscard]] tl::expected<void, LogicFailure> set_at_tool_change_position(bool there);
  /// Remote RUN or STOP of the PLC, by M8035 to M8037.
  [[nodiscard]] tl::expected<void, LogicFailure> set_plc_running(bool run);

  /// Strobes off, M code 0, DEN on, a pulse on the reset signal, "program running" off. Gives up at the first failed exchange:
  /// a PLC that cannot be reached cannot be reset.
  tl::expected<void, LogicFailure> reset();

 private:
  using Clock = std::chrono::steady_clock;

  tl::expected<void, LogicFailure> set_strobes(std::byte strobes);
  tl::expected<void, LogicFailure> wait_until_ready();
  tl::expected<void, LogicFailure> wait_tmf();
  tl::expected<void, LogicFailure> wait_for_fin(bool on, Clock::time_point since);
  tl::expected<std::byte, LogicFailure> read_status(Clock::time_point not_before);
  tl::expected<void, LogicFailure> check_health(std::byte status, Clock::time_point since);
  tl::expected<void, LogicFailure> write_strobe_byte();
  LogicFailure alarm_failure(Clock::time_point since);
  template <typename Notify>
  void tell(const FunctionRequest& request, Notify notify) const;

  std::unique_ptr<PlcLink> own_link_;
  PlcLink& link_;
  LogicTaskOptions options_;
  LogicTaskObserver* observer_;
  const std::atomic<bool>* stop_;
  std::atomic<bool> aborted_{false};
  std::mutex strobe_byte_mutex_;  ///< held over the write, so that the PLC sees the changes in their order
  std::byte strobes_{0};
  bool motion_under_way_ = false;
  FunctionRequest raised_;
  Clock::time_point raised_at_;
  /// Last values of D100 to D102.
  std::array<std::uint16_t, 3> values_{};
};

}  // namespace kernel_mocks
