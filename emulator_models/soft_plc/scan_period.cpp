#include "emulator_models/soft_plc/scan_period.hpp"

#include "protocol/check.hpp"

namespace emulator_models::soft_plc {

using std::chrono::nanoseconds;

ScanPeriod::ScanPeriod(nanoseconds period, OverrunRule rule, nanoseconds first_start) noexcept
    : period_{period}, rule_{rule}, due_{first_start} {
  PLC_CHECK(period >= nanoseconds{0});
}

bool ScanPeriod::begin_scan(nanoseconds now) noexcept {
  start_delay_ = now - due_;
  bool starts_were_lost = false;
  if (period_ > nanoseconds{0}) {
    const std::int64_t allowed = rule_ == OverrunRule::catch_up ? catch_up_max : 0;
    const std::int64_t behind = (now - due_) / period_;
#ifdef LTSIM_MUTANT_CATCH_UP_WITHOUT_BOUND
    if (behind > allowed && rule_ != OverrunRule::catch_up) {
#else
    if (behind > allowed) {
#endif
      lose_starts(behind - allowed);
      starts_were_lost = true;
    }
  }
  return starts_were_lost;
}

bool ScanPeriod::end_scan(nanoseconds now) noexcept {
  if (period_ == nanoseconds{0}) {
    due_ = now;
    return false;
  }
  due_ += period_;
  if (now <= due_) return false;
  ++overruns_count_;
  if (rule_ != OverrunRule::catch_up) lose_starts((now - due_ + period_ - nanoseconds{1}) / period_);
  return true;
}

void ScanPeriod::lose_starts(std::int64_t count) noexcept {
  lost_starts_count_ += static_cast<std::uint64_t>(count);
  due_ += count * period_;
}

}  // namespace emulator_models::soft_plc
