// The operator's buttons and switches, for any thread to press, and what presses them by itself.
//
// The runner takes the events in their order, between two looks at its tasks. An event that means nothing at the
// moment (cycle start while the program runs) does nothing.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

namespace kernel_mocks {

enum class OperatorEvent : std::uint8_t {
  cycle_start,     ///< ends a feed hold and a program stop
  feed_hold,       ///< holds the axes; no further block begins
  reset,           ///< ends the program, resets the PLC
  abort,           ///< ends the program, as SIGINT does
  emergency_stop,  ///< of the kernel: ends the program at once
  plc_run,         ///< remote RUN of the PLC (M8035, M8036)
  plc_stop,        ///< remote STOP of the PLC (M8037)
  optional_stop_on,
  optional_stop_off,
};
inline constexpr unsigned operator_event_count = 9;

/// "feed-hold": as scripts write it.
[[nodiscard]] std::string_view to_string(OperatorEvent event) noexcept;

class OperatorPanel {
 public:
  void press(OperatorEvent event);
  /// @return the oldest event that was not taken yet
  [[nodiscard]] std::optional<OperatorEvent> take();

 private:
  std::mutex mutex_;
  std::deque<OperatorEvent> events_;
};

/// Presses buttons when their time has come; asked by the runner, in its thread.
class Operator {
 public:
  virtual ~Operator() = default;
  /// @param elapsed  since the program start
  virtual void look(std::chrono::nanoseconds elapsed, OperatorPanel& panel) = 0;
  virtual void block_begun(std::uint32_t /*number*/, OperatorPanel& /*panel*/) {}
  /// Nobody is there any more: who waits for cycle start would wait for ever.
  [[nodiscard]] virtual bool has_left() const = 0;

 protected:
  Operator() = default;
  Operator(const Operator&) = default;
  Operator& operator=(const Operator&) = default;
};

struct OperatorScriptEntry {
  /// A time since the program start, or the number (N) of the block that begins.
  std::variant<std::chrono::nanoseconds, std::uint32_t> when;
  OperatorEvent event;
  bool operator==(const OperatorScriptEntry&) const = default;
};
using OperatorScript = std::vector<OperatorScriptEntry>;

/// Each entry once. It has left when no entry with a time is left: a stop begins no block.
class ScriptedOperator final : public Operator {
 public:
  explicit ScriptedOperator(OperatorScript script) : script_{std::move(script)} {}
  void look(std::chrono::nanoseconds elapsed, OperatorPanel& panel) override;
  void block_begun(std::uint32_t number, OperatorPanel& panel) override;
  [[nodiscard]] bool has_left() const override;

 private:
  OperatorScript script_;
};

/// At every interval one of the given events, or a cycle start (choice 0), so that no program stands for ever.
class RandomOperator final : public Operator {
 public:
  /// @param bound  above zero
  /// @return       0 to bound - 1
  using Choose = std::function<std::uint32_t(std::uint32_t bound)>;

  RandomOperator(std::vector<OperatorEvent> events, std::chrono::nanoseconds interval, Choose choose)
      : events_{std::move(events)}, interval_{interval}, choose_{std::move(choose)} {}
  void look(std::chrono::nanoseconds elapsed, OperatorPanel& panel) override;
  [[nodiscard]] bool has_left() const override { return false; }

 private:
  std::vector<OperatorEvent> events_;
  std::chrono::nanoseconds interval_;
  Choose choose_;
  std::chrono::nanoseconds next_{0};
};

}  // namespace kernel_mocks
