// The grid of scan starts, against what scan_period.hpp says of it.

#include <ostream>

#include "emulator_models/soft_plc/scan_period.hpp"
#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

using emulator_models::soft_plc::OverrunRule;
using emulator_models::soft_plc::ScanPeriod;
using std::chrono::nanoseconds;

struct Scan {
  nanoseconds late;  ///< after it was due
  nanoseconds lasts;
};

void showValue(const Scan& scan, std::ostream& out) {
  out << "late " << scan.late.count() << " lasts " << scan.lasts.count();
}

/// Small numbers, so that what is exactly in time is not rare; now and then the host was away for long.
rc::Gen<Scan> any_scan(int period) {
  return rc::gen::exec([period] {
    const auto duration = [period](int on_time_of_ten) {
      if (*rc::gen::inRange(0, 10) < on_time_of_ten) return nanoseconds{0};
      return nanoseconds{*rc::gen::oneOf(
          rc::gen::inRange(0, 3 * period + 3), rc::gen::inRange(0, 3 * period + 3),
          rc::gen::map(rc::gen::inRange(0, 300), [period](int periods) { return period * periods; }))};
    };
    const nanoseconds late = duration(7);
    return Scan{late, duration(1)};
  });
}

class Grid {
 public:
  Grid()
      : period_length_{*rc::gen::inRange(1, 12)},
        rule_{*rc::gen::element(OverrunRule::stop, OverrunRule::skip, OverrunRule::catch_up)} {}

  void run() {
    for (const Scan& scan : *rc::gen::container<std::vector<Scan>>(any_scan(period_length_))) step(scan);
  }

 private:
  void step(const Scan& scan) {
    const nanoseconds was_due = period_.due();
    const nanoseconds start = std::max(end_, was_due) + scan.late;
    const auto lost_before = period_.lost_starts_count();
    const bool starts_lost = period_.begin_scan(start);
    RC_ASSERT(period_.start_delay() == start - was_due);
    RC_ASSERT(starts_lost == (period_.lost_starts_count() > lost_before));
    const std::int64_t allowed = rule_ == OverrunRule::catch_up ? ScanPeriod::catch_up_max : 0;
    const nanoseconds point = period_.due();  // that this scan has on the grid
    RC_ASSERT((start - point) / period() <= allowed);
    if (starts_lost) RC_ASSERT((start - point) / period() == allowed);  // no more than need be

    end_ = start + scan.lasts;
    const auto overruns_before = period_.overruns_count();
    const bool overrun = period_.end_scan(end_);
    ++scans_;
    RC_ASSERT(overrun == (end_ > point + period()));  // one that ends on the next point is in time
    RC_ASSERT(period_.overruns_count() == overruns_before + (overrun ? 1U : 0U));
    const nanoseconds due = period_.due();
    if (rule_ == OverrunRule::catch_up || !overrun) {
      RC_ASSERT(due == point + period());
    } else {
      RC_ASSERT(due >= end_);            // I2
      RC_ASSERT(due - period() < end_);  // the next one that has not passed
    }
    RC_ASSERT(due - was_due >= period());                       // I1
    RC_ASSERT((due - first_).count() % period().count() == 0);  // on the grid
    RC_ASSERT(static_cast<std::uint64_t>((due - first_) / period()) ==
              scans_ + period_.lost_starts_count());  // I3
  }

  [[nodiscard]] nanoseconds period() const { return nanoseconds{period_length_}; }

  int period_length_;
  OverrunRule rule_;
  nanoseconds first_{*rc::gen::inRange(0, 100)};
  ScanPeriod period_{period(), rule_, first_};
  nanoseconds end_ = first_;
  std::uint64_t scans_ = 0;
};

PROPERTY(ScanPeriod, keeps_its_grid_whatever_starts_late_or_lasts_long, ()) { Grid{}.run(); }

PROPERTY(ScanPeriod, of_zero_is_due_at_each_end_and_never_overruns, ()) {
  ScanPeriod period{nanoseconds{0},
                    *rc::gen::element(OverrunRule::stop, OverrunRule::skip, OverrunRule::catch_up),
                    nanoseconds{0}};
  nanoseconds now{0};
  for (const Scan& scan : *rc::gen::container<std::vector<Scan>>(any_scan(10))) {
    now += scan.late;
    RC_ASSERT(!period.begin_scan(now));
    now += scan.lasts;
    RC_ASSERT(!period.end_scan(now));
    RC_ASSERT(period.due() == now);
  }
  RC_ASSERT(period.overruns_count() + period.lost_starts_count() == 0U);
}

}  // namespace
}  // namespace property_tests
