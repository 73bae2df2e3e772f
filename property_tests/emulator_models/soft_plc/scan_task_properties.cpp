// Whole scans of a cycle, with orders and durations at random, against a scan told from top to bottom as
// scan_engine.md and the watchdog's header have it.

#include <algorithm>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

#include "emulator_models/soft_plc/scan_task.hpp"
#include "property_tests/support/property.hpp"

namespace property_tests {
namespace {

using namespace emulator_models::soft_plc;
using std::chrono::nanoseconds;

char letter(ScanAction action) {
  static const std::map<ScanAction, char> letters{{ScanAction::system_analysis, 'A'},
                                                  {ScanAction::clear_fault, 'l'},
                                                  {ScanAction::initialise, 'N'},
                                                  {ScanAction::write_safe_outputs, 'S'},
                                                  {ScanAction::read_inputs, 'I'},
                                                  {ScanAction::read_from_cycles, 'F'},
                                                  {ScanAction::execute, 'X'},
                                                  {ScanAction::write_to_cycles, 'T'},
                                                  {ScanAction::write_outputs, 'O'},
                                                  {ScanAction::refresh_output_image, 'G'},
                                                  {ScanAction::wait, '.'},
                                                  {ScanAction::enter_fault, '!'}};
  return letters.at(action);
}

/// What happens in one scan.
struct Script {
  int late;
  std::vector<int> durations;  ///< of its steps, the first ones; the others take 0
  int slices;
  bool fails;    ///< its last slice does
  char order;    ///< ' ' none, 'c' cold RUN, 'w' warm RUN, 's' STOP, 'r' reset, 'R' reset and RUN
  int order_at;  ///< in which step
};

void showValue(const Script& script, std::ostream& out) {
  out << "late " << script.late << ", steps ";
  for (const int duration : script.durations) out << duration << ' ';
  out << ", slices " << script.slices << (script.fails ? " fails" : "") << ", order '" << script.order
      << "' in step " << script.order_at;
}

rc::Gen<Script> any_script() {
  return rc::gen::exec([] {
    Script script{};
    script.late = *rc::gen::inRange(0, 4) != 0 ? 0 : *rc::gen::inRange(0, 40);
    script.durations = *rc::gen::container<std::vector<int>>(*rc::gen::inRange<std::size_t>(0, 10),
                                                             rc::gen::element(0, 0, 1, 1, 2, 5));
    script.slices = *rc::gen::element(1, 1, 2, 3);
    script.fails = *rc::gen::inRange(0, 12) == 0;
    script.order = *rc::gen::element(' ', ' ', ' ', 'c', 'w', 'R', 'r', 's');
    script.order_at = *rc::gen::inRange(0, 9);
    return script;
  });
}

/// A cycle as it should be.
class Told {
 public:
  explicit Told(const ScanConfig& config) : config_{config} {}

  struct Scan {
    std::string letters;
    nanoseconds end{0};
  };

  /// @param due    point of the grid that the scan has
  Scan scan(const Script& script, nanoseconds due, nanoseconds start) {
    script_ = &script;
    start_ = now_ = start;
    letters_.clear();
    step_ = 0;
    const nanoseconds lost =
        config_.period == nanoseconds{0} ? nanoseconds{0} : (start - due) / config_.period * config_.period;
    const bool stops = config_.overrun == OverrunRule::stop;
    if (stops && lost > nanoseconds{0} && runs_) {
      enter_fault(FaultCode::overrun);
    } else {
      phases();
    }
    if (stops && runs_ && config_.period > nanoseconds{0} && now_ > due + lost + config_.period)
      enter_fault(FaultCode::overrun);
    return {letters_, now_};
  }

  bool order(char what) {
    if (what == 's') {
      wants_run_ = false;
      was_stopped_ = true;
    }
    if ((what == 'r' || what == 'R') && fault) reset_ = true;
    if (what != 'c' && what != 'w' && what != 'R') return true;
    if (fault && !reset_) return false;
    wants_run_ = true;
    start_kind = what == 'c' ? StartKind::cold : StartKind::warm;
    return true;
  }

  std::optional<FaultCode> fault;
  StartKind start_kind = StartKind::cold;

 private:
  void phases() {
    if (!does('A')) return;
    if (std::exchange(reset_, false)) {
      fault.reset();
      if (!does('l')) return;
    }
    const bool ran = std::exchange(runs_, wants_run_);
    const bool was_stopped = std::exchange(was_stopped_, false);
    if (runs_ && (!ran || was_stopped)) {
      if (!does('N')) return;
    } else if (!runs_ && ran && config_.outputs_in_stop == OutputsInStop::safe) {
      if (!does('S')) return;
    }
    if (!does('I')) return;
    if (!runs_) {
      does('G');
      return;
    }
    if (config_.exchanges_with_cycles && !does('F')) return;
    for (int slice = 1; slice <= script_->slices; ++slice) {
      if (!does('X', script_->fails && slice == script_->slices)) return;
    }
    if (config_.exchanges_with_cycles && !does('T')) return;
    does('O');
  }

  /// @return whether the scan goes on
  bool does(char what, bool fails = false) {
    takes_time(what);
    if (fails && !fault) return enter_fault(FaultCode::program_failed);
    if (runs_ && now_ - start_ > config_.watchdog_limit) return enter_fault(FaultCode::watchdog);
    return true;
  }

  bool enter_fault(FaultCode code) {
    fault = code;
    runs_ = wants_run_ = false;
    takes_time('!');
    return false;
  }

  void takes_time(char what) {
    letters_ += what;
    if (step_ == script_->order_at) order(script_->order);
    if (static_cast<std::size_t>(step_) < script_->durations.size())
      now_ += nanoseconds{script_->durations[static_cast<std::size_t>(step_)]};
    ++step_;
  }

  ScanConfig config_;
  const Script* script_ = nullptr;
  nanoseconds start_{0};
  nanoseconds now_{0};
  std::string letters_;
  int step_ = 0;
  bool runs_ = false;
  bool wants_run_ = false;
  bool was_stopped_ = false;
  bool reset_ = false;
};

bool order(ScanTask& task, char what) {
  if (what == 's') task.order_stop();
  if (what == 'r' || what == 'R') task.order_reset();
  if (what == 'c' || what == 'w' || what == 'R')
    return task.order_run(what == 'c' ? StartKind::cold : StartKind::warm);
  return true;
}

PROPERTY(ScanTask, does_the_phases_in_their_order_and_trips_just_beyond_the_limit, ()) {
  ScanConfig config;
  config.period = nanoseconds{*rc::gen::inRange(0, 30)};
  config.overrun = *rc::gen::element(OverrunRule::stop, OverrunRule::skip, OverrunRule::catch_up);
  config.watchdog_limit = nanoseconds{*rc::gen::inRange(1, 14)};
  config.exchanges_with_cycles = *rc::gen::arbitrary<bool>();
  config.outputs_in_stop = *rc::gen::element(OutputsInStop::safe, OutputsInStop::hold);
  const auto scripts = *rc::gen::container<std::vector<Script>>(any_script());

  ScanTask task = ScanTask::make(config, nanoseconds{0}).value();
  Told told{config};
  RC_ASSERT(order(task, 'c') == told.order('c'));
  nanoseconds now{0};
  for (const Script& script : scripts) {
    const nanoseconds due = task.period().due();
    if (now < due) RC_ASSERT(task.next(due - nanoseconds{1}).action == ScanAction::wait);
    now = std::max(now, due) + nanoseconds{script.late};
    const nanoseconds start = now;
    std::string letters;
    Progress last = Progress::finished;
    int slices = 0;
    int step_number = 0;
    for (;;) {
      const ScanStep step = task.next(now, last);
      if (step.action == ScanAction::wait) break;
      RC_ASSERT(step.scan_start == start);
      letters += letter(step.action);
      RC_ASSERT(letters.size() < 40U);
      if (step_number == script.order_at) order(task, script.order);
      if (static_cast<std::size_t>(step_number) < script.durations.size())
        now += nanoseconds{script.durations[static_cast<std::size_t>(step_number)]};
      ++step_number;
      last = Progress::finished;
      if (step.action == ScanAction::execute) {
        ++slices;
        last = slices < script.slices ? Progress::unfinished
               : script.fails         ? Progress::failed
                                      : Progress::finished;
      }
    }
    const Told::Scan expected = told.scan(script, due, start);
    RC_ASSERT(letters == expected.letters);
    RC_ASSERT(task.fault().has_value() == told.fault.has_value());
    if (task.fault()) RC_ASSERT(static_cast<int>(task.fault()->code) == static_cast<int>(*told.fault));
  }
}

PROPERTY(Watchdog, bites_beyond_its_limit_and_only_the_next_scan_begins_anew, ()) {
  const nanoseconds limit{*rc::gen::inRange(1, 1000)};
  Watchdog watchdog{limit};
  nanoseconds begin{0};
  for (const int gap : *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1000, 2500))) {
    if (gap < 0) {  // a scan begins
      begin -= nanoseconds{gap};
      watchdog.begin_scan(begin);
    } else {
      RC_ASSERT(watchdog.bites(begin + nanoseconds{gap}) == (nanoseconds{gap} > limit));
    }
    RC_ASSERT(!watchdog.bites(watchdog.deadline()));
    RC_ASSERT(watchdog.bites(watchdog.deadline() + nanoseconds{1}));
  }
}

}  // namespace
}  // namespace property_tests
