// The soft PLC: cycles with their images, what they share, orders, faults, and the watchdog over all. It has no threads
// and no clock; who calls brings both (plc_threads.hpp).
//
//   advance()            one slice of the cycle that ScanScheduler names: all cycles on one thread
//   advance_cycle(i)     one step of cycle i: a thread for each cycle, priorities are the host's matter
//   supervise()          the watchdog, on a thread of its own: works while a cycle hangs within a step
//
// Invariants
//   I1  (I19) the outputs of a run are dead from the moment at which its STOP is carried out or a fault is seen:
//       the first cycle that gets there closes the gate for all.
//   I2  (I20) supervise() stops the PLC when a scan has lasted longer than its limit, also while its step has not
//       come back. Nothing but the end of a whole scan earns more time (I22); a scan as long as the limit is
//       normal (I21).
//   I3  a fault in one cycle, or in a driver that may not fail, stops all.
//   I4  RUN after a fault needs a reset, and no reset is accepted while a cycle still hangs.
// Orders, status and gateway: any thread. advance() or advance_cycle(i): one thread at a time each, and never mixed.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/inheriting_mutex.hpp"
#include "emulator_models/soft_plc/plc_cycle.hpp"
#include "emulator_models/soft_plc/scan_scheduler.hpp"
#include "emulator_models/soft_plc/start_delays.hpp"

namespace emulator_models::soft_plc {

inline constexpr std::size_t cycles_max = 32;

struct PlcCycleSetup {
  std::string name;
  CycleConfig config;
  Section sends;  ///< of %M
  std::unique_ptr<CycleBody> body;
};

struct SoftPlcSetup {
  std::vector<PlcCycleSetup> cycles;  ///< 1 to cycles_max
  std::vector<std::chrono::nanoseconds> slice_intervals;
  std::vector<IoManager::Slot> drivers;
  GatewayLimits gateway;
  OutputGate::Outputs safe_outputs{};
  PlcObserver* observer = nullptr;  ///< outlives the PLC; null: nobody watches
};

struct CycleStatus {
  RunMode mode = RunMode::stop;
  std::optional<Fault> fault;
  ScanTimes scan_times;
  std::uint64_t overruns_count = 0;
  std::uint64_t lost_starts_count = 0;
};

class SoftPlc {
 public:
  /// In STOP.
  /// @return the PLC; or what is wrong with the setup, naming the cycle
  [[nodiscard]] static tl::expected<std::unique_ptr<SoftPlc>, std::string> make(SoftPlcSetup setup,
                                                                                std::chrono::nanoseconds now);
  SoftPlc(const SoftPlc&) = delete;
  SoftPlc& operator=(const SoftPlc&) = delete;
  ~SoftPlc() { gateway_->close(); }

  /// @return false = refused: there is a fault that is not reset, or the PLC is retired
  bool order_run(StartKind start) noexcept;
  void order_stop() noexcept;
  /// order_stop, and the outputs are safe on return: for the end of the PLC, when no scan will carry the order out.
  void stop_now() noexcept;
  /// For who replaces the PLC: from here on no RUN is accepted.
  /// @return false = refused: the PLC is in RUN, or about to be
  [[nodiscard]] bool retire() noexcept;
  /// @return false = refused: a cycle has not come back from the step in which it was stopped
  bool order_reset() noexcept;

  /// @return when to call again; up to `now` = at once
  std::chrono::nanoseconds advance(std::chrono::nanoseconds now) noexcept;
  std::chrono::nanoseconds advance_cycle(std::size_t index, std::chrono::nanoseconds now) noexcept;
  /// @return the first moment at which there could be something to do
  std::chrono::nanoseconds supervise(std::chrono::nanoseconds now) noexcept;

  /// The new periods, limits and overrun rules count from the next scan of each cycle on, in RUN, too.
  /// @param scans  one for each cycle
  /// @return       what is wrong; nothing is changed then
  tl::expected<void, std::string> reconfigure(const std::vector<ScanConfig>& scans,
                                              const GatewayLimits& gateway) noexcept;

  [[nodiscard]] std::size_t cycles_count() const noexcept { return cycles_.size(); }
  [[nodiscard]] const std::string& name(std::size_t index) const noexcept { return cycles_[index].name; }
  [[nodiscard]] std::size_t priority(std::size_t index) const noexcept { return cycles_[index].priority; }
  [[nodiscard]] CycleStatus status(std::size_t index) const noexcept;
  /// Of all scans since the last start of RUN.
  [[nodiscard]] StartDelays start_delays(std::size_t index) const noexcept;
  /// Whether all cycles are in STOP and no RUN is ordered.
  [[nodiscard]] bool is_stopped() const noexcept;
  [[nodiscard]] bool alarm_lamp() const noexcept { return parts_.lamp.is_on(); }
  [[nodiscard]] Gateway& gateway() noexcept { return *gateway_; }
  [[nodiscard]] IoManager& io() noexcept { return parts_.io; }
  [[nodiscard]] OutputGate& gate() noexcept { return parts_.gate; }

 private:
  struct Cycle {
    std::string name;
    std::unique_ptr<PlcCycle> program;
    std::size_t priority = 0;
    ScanConfig config;
    Progress last = Progress::finished;             ///< of the thread that advances the cycle
    bool halt_pending = false;                      ///< told to enter its fault, and not there yet
    std::optional<std::chrono::nanoseconds> limit;  ///< of the scan under way
    StartDelays start_delays;
  };

  SoftPlc(SoftPlcSetup setup, ScanScheduler scheduler, std::chrono::nanoseconds now);
  /// Under the lock: what has to be known before the step is carried out.
  void prepare(std::size_t index, const ScanStep& step) noexcept;
  [[nodiscard]] bool is_stopped_locked() const noexcept;
  void stop_all(std::chrono::nanoseconds now, FaultCode others) noexcept;
  void tell_observer(std::size_t index, std::chrono::nanoseconds now) noexcept;

  PlcParts parts_;
  std::unique_ptr<Gateway> gateway_;
  std::optional<std::size_t> running_;  ///< of the thread that calls advance()
  mutable InheritingMutex mutex_;
  // All guarded by mutex_, but for what says otherwise.
  ScanScheduler scheduler_;
  std::vector<Cycle> cycles_;
  std::uint64_t run_ = 0;
  bool run_is_ordered_ = false;
  bool is_retired_ = false;
  bool holds_outputs_ = false;
};

}  // namespace emulator_models::soft_plc
