// A soft PLC as its configuration says, and the change to another configuration while it works.
//
// While in RUN may change: period, watchdog's limit and overrun rule of a cycle, limits of the gateway. They count from the
// next scan of each cycle on. All else needs STOP: then the PLC is built anew.
//
// Invariants
//   I1  a configuration that is bad, or that needs a STOP which is not there, changes nothing: the old one goes on.
//   I2  a PLC that is replaced takes no RUN any more, in whatever order the two are asked for: a RUN that was accepted
//       is one of the PLC that goes on.
//   I3  what comes over the wire takes the same way as a file, once its sum is right.
// Any thread; reload() holds up no scan.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "emulator_models/soft_plc/il_cycle.hpp"
#include "emulator_models/soft_plc/plc_configuration.hpp"
#include "emulator_models/soft_plc/plc_observer.hpp"
#include "emulator_models/soft_plc/real_time_values.hpp"

namespace emulator_models::soft_plc {

/// @return a driver of the kind, or nullptr if there is no such kind
using DriverFactory = std::function<std::unique_ptr<IoDriver>(const ConfiguredDriver&)>;

/// @param power_up  when the PLC that is to be watched begins, by its clock
/// @return          an observer that goes with the PLC, when no cycle runs any more; nullptr: nobody watches; or what is
///                  wrong with the archive that is asked for
using ObserverFactory = std::function<tl::expected<std::unique_ptr<PlcObserver>, std::string>(
    const PlcConfiguration&, std::chrono::nanoseconds power_up)>;

/// The real-time values of a cycle, in the order of PlcConfiguration::realtime_signals; all of one scan.
struct RealTimeReading {
  ReadOutcome outcome = ReadOutcome::nothing_published;
  ScanStamp stamp;                    ///< of no meaning unless `read`, as what follows
  std::vector<std::uint64_t> values;  ///< a bit is 0 or 1; no sign
};

/// @return what has changed that needs a STOP, "the program of cycle fast"; empty if nothing
[[nodiscard]] std::string change_that_needs_stop(const PlcConfiguration& old, const PlcConfiguration& next);

class ConfiguredPlc {
 public:
  /// Without a PLC until the first reload.
  /// @param file_name  stands in front of errors; programs are looked for in its folder
  /// @param observers  asked once for each PLC that is built; empty: nobody watches
  ConfiguredPlc(std::string file_name, FileReader reader, DriverFactory factory, PlcClock& clock,
                ObserverFactory observers = {});
  ConfiguredPlc(const ConfiguredPlc&) = delete;
  ConfiguredPlc& operator=(const ConfiguredPlc&) = delete;
  ~ConfiguredPlc();

  /// @return nothing; or why the old configuration goes on
  [[nodiscard]] tl::expected<void, std::string> reload(std::string_view text) {
    return reload(text, file_name_);
  }
  /// @param name  of a text that is not the file; stands in front of errors in its place, ":line:column: " after it
  [[nodiscard]] tl::expected<void, std::string> reload(std::string_view text, const std::string& name);
  /// The PLC of now; one that was replaced refuses what is asked of its gateway. None before the first reload.
  [[nodiscard]] std::shared_ptr<SoftPlc> plc() const;
  [[nodiscard]] PlcConfiguration configuration() const;
  /// For field devices that wait at the gateway.
  [[nodiscard]] std::chrono::milliseconds answer_timeout() const;
  /// @param index  of a cycle of plc()
  /// @return       where its program has failed, since its last start; none for an index that is not there
  [[nodiscard]] std::optional<RunTimeFault> run_time_fault(std::size_t index) const;
  /// @param index  of a cycle of plc(); reading it holds up no scan
  [[nodiscard]] RealTimeReading realtime_values(std::size_t index) const;
  [[nodiscard]] std::string realtime_refusal() const;

 private:
  [[nodiscard]] tl::expected<void, std::string> build(const PlcConfiguration& next, const std::string& name,
                                                      const std::string& change);

  const std::string file_name_;
  const FileReader reader_;
  const DriverFactory factory_;
  const ObserverFactory observers_;
  PlcClock& clock_;
  mutable std::mutex mutex_;
  // All guarded by mutex_.
  PlcConfiguration configuration_;
  std::shared_ptr<SoftPlc> plc_;
  std::vector<const IlCycle*> programs_;   ///< of plc_
  const PlcObserver* observer_ = nullptr;  ///< of plc_; null: nobody watches
  std::unique_ptr<PlcThreads> threads_;
};

}  // namespace emulator_models::soft_plc
