// Makes the choices that a schedule holds, and the default everywhere else.
//
// A line whose place is never reached, or whose task cannot run there, is not passed over: divergence() names
// the first one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sim_clock/explore/anchor_tracker.hpp"
#include "sim_clock/explore/schedule.hpp"
#include "sim_clock/explore/strategy.hpp"

namespace ltsim {

class ReplayStrategy final : public Strategy {
 public:
  /// @param anchors  must be the listener of the same execution
  ReplayStrategy(const std::vector<Deviation>& deviations, const World& world, const AnchorTracker& anchors);

  [[nodiscard]] std::string_view name() const noexcept override { return "replay"; }
  /// The seed does not matter.
  void begin_execution(std::uint64_t seed) noexcept override;
  [[nodiscard]] std::size_t choose_task(const TaskChoice& choice) noexcept override;
  [[nodiscard]] SlowMoment slow_moment(const SlowMomentChoice& choice) noexcept override;
  [[nodiscard]] std::size_t strike(FaultKind kind, std::size_t variants_count) noexcept override;
  [[nodiscard]] std::size_t answer(std::size_t count) noexcept override;
  [[nodiscard]] std::size_t choose_age(const AgeChoice& choice) noexcept override;

  struct Divergence {
    const Deviation* deviation;
    std::string reason;
  };
  /// After the execution: the first deviation, in the order of the schedule, that was not carried out.
  [[nodiscard]] std::optional<Divergence> divergence() const;

 private:
  struct Entry {
    const Deviation* deviation;
    bool reached = false;
    bool carried_out = false;
  };

  /// @param fault  which one, if the kind is `fault`
  [[nodiscard]] Entry* entry_here(Deviation::Kind kind, FaultKind fault = FaultKind::crash) noexcept;

  /// @return  the variant that kills that process; 0: it cannot be killed here
  [[nodiscard]] std::size_t crash_of(std::string_view process, std::size_t variants_count) const;

  const World& world_;
  const AnchorTracker& anchors_;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::vector<std::size_t>> entries_at_;  // by anchor
};

}  // namespace ltsim
