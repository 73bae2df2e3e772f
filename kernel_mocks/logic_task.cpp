#include "kernel_mocks/logic_task.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <thread>

#include "kernel_mocks/plc_signals.hpp"
#include "protocol/check.hpp"

namespace kernel_mocks {
namespace {

tl::unexpected<LogicFailure> link_lost(FxDriverError error) {
  return tl::unexpected{LogicFailure{.fault = LogicFault::link_lost, .link = error}};
}

tl::expected<void, LogicFailure> as_logic(const tl::expected<void, FxDriverError>& done) {
  if (!done) return link_lost(done.error());
  return {};
}

constexpr bool is_on(std::byte status, std::byte signal) noexcept {
  return (status & signal) != std::byte{0};
}

}  // namespace

LogicTask::LogicTask(FxDriver& driver, const LogicTaskOptions& options, LogicTaskObserver* observer,
                     const std::atomic<bool>* stop)
    : own_link_{std::make_unique<DirectLink>(driver)},
      link_{*own_link_},
      options_{options},
      observer_{observer},
      stop_{stop} {}

LogicTask::LogicTask(PlcLink& link, const LogicTaskOptions& options, LogicTaskObserver* observer,
                     const std::atomic<bool>* stop)
    : link_{link}, options_{options}, observer_{observer}, stop_{stop} {}

tl::expected<void, LogicFailure> LogicTask::begin_program() {
  aborted_.store(false);
  if (auto done = reset(); !done) return done;
  if (auto done = as_logic(link_.force(signals::feed_hold_active, false)); !done) return done;
  if (auto done = wait_until_ready(); !done) return done;
  return as_logic(link_.force(signals::program_running, true));
}

tl::expected<void, LogicFailure> LogicTask::raise(const FunctionRequest& request) {
  PLC_CHECK(request.m || request.s || request.t);
  if (auto done = wait_for_fin(false, Clock::now()); !done) return done;

  values_ = {request.m.value_or(0), request.s.value_or(values_[1]), request.t.value_or(values_[2])};
  if (auto done = as_logic(link_.write_words(signals::m_code, values_)); !done) return done;

  if (auto done = wait_tmf(); !done) return done;
  const auto strobe = [](bool wanted, std::byte bit) { return wanted ? bit : std::byte{0}; };
  if (auto done = set_strobes(strobe(request.m.has_value(), signals::strobe_m) |
                              strobe(request.s.has_value(), signals::strobe_s) |
                              strobe(request.t.has_value(), signals::strobe_t));
      !done) {
    return done;
  }
  raised_ = request;
  raised_at_ = Clock::now();
  tell(request, [this](FunctionKind kind, std::uint16_t number) { observer_->strobe_raised(kind, number); });
  return {};
}

tl::expected<std::chrono::nanoseconds, LogicFailure> LogicTask::acknowledge() {
  if (auto done = wait_for_fin(true, raised_at_); !done) return tl::unexpected{done.error()};
  const std::chrono::nanoseconds duration = Clock::now() - raised_at_;
  tell(raised_,
       [&](FunctionKind kind, std::uint16_t number) { observer_->finished(kind, number, duration); });
  if (auto done = set_strobes(std::byte{0}); !done) return tl::unexpected{done.error()};
  if (auto done = wait_for_fin(false, Clock::now()); !done) return tl::unexpected{done.error()};
  return duration;
}

tl::expected<void, LogicFailure> LogicTask::end_program() {
  return as_logic(link_.force(signals::program_running, false));
}

tl::expected<void, LogicFailure> LogicTask::reset() {
  {
    const std::scoped_lock lock{strobe_byte_mutex_};
    motion_under_way_ = false;
  }
  if (auto done = set_strobes(std::byte{0}); !done) return done;
  // Speed and tool number stay: they are modal, a reset does not take them back.
  values_[0] = 0;
  if (auto done = as_logic(link_.write_words(signals::m_code, std::span{values_}.first(1))); !done)
    return done;
  if (auto done = as_logic(link_.force(signals::reset, true)); !done) return done;
  std::this_thread::sleep_for(options_.reset_pulse);
  if (auto done = as_logic(link_.force(signals::reset, false)); !done) return done;
  return as_logic(link_.force(signals::program_running, false));
}

tl::expected<void, LogicFailure> LogicTask::set_strobes(std::byte strobes) {
  const std::scoped_lock lock{strobe_byte_mutex_};
  strobes_ = strobes;
  return write_strobe_byte();
}

tl::expected<void, LogicFailure> LogicTask::set_motion_under_way(bool under_way) {
  const std::scoped_lock lock{strobe_byte_mutex_};
  motion_under_way_ = under_way;
  return write_strobe_byte();
}

tl::expected<void, LogicFailure> LogicTask::write_strobe_byte() {
  const std::array bytes{strobes_ | (motion_under_way_ ? std::byte{0} : signals::distribution_end)};
  return as_logic(link_.write_bytes(signals::strobe_byte, bytes));
}

tl::expected<void, LogicFailure> LogicTask::set_feed_hold(bool active) {
  return as_logic(link_.force(signals::feed_hold_active, active));
}

tl::expected<void, LogicFailure> LogicTask::set_at_tool_change_position(bool there) {
  return as_logic(link_.force(signals::at_tool_change_position, there));
}

tl::expected<void, LogicFailure> LogicTask::set_plc_running(bool run) {
  if (!run) return as_logic(link_.force(signals::plc_forced_stop, true));
  // The forced run counts only while the mode switch is overruled: that first.
  if (auto done = as_logic(link_.force(signals::plc_forced_mode, true)); !done) return done;
  return as_logic(link_.force(signals::plc_forced_run, true));
}

tl::expected<std::byte, LogicFailure> LogicTask::healthy_status() {
  const auto status = link_.status();
  if (!status) return link_lost(status.error());
  const auto now = Clock::now();
  if (now - status->read_at > options_.status_age_max) return link_lost(FxDriverError::no_answer);
  if (const auto healthy = check_health(status->signals, now); !healthy)
    return tl::unexpected{healthy.error()};
  return status->signals;
}

tl::expected<void, LogicFailure> LogicTask::check_health(std::byte status, Clock::time_point since) {
  // An open chain drops everything at once; alarms that follow from it say less.
  if (!is_on(status, signals::emergency_stop_ok)) {
    return tl::unexpected{LogicFailure{.fault = LogicFault::emergency_stop, .after = Clock::now() - since}};
  }
  if (is_on(status, signals::alarm)) return tl::unexpected{alarm_failure(since)};
  return {};
}

tl::expected<void, LogicFailure> LogicTask::wait_until_ready() {
  const auto since = Clock::now();
  for (;;) {
    if (interrupted()) return tl::unexpected{LogicFailure{.fault = LogicFault::interrupted}};
    const auto status = read_status(since);
    if (!status) return tl::unexpected{status.error()};
    const bool alarm = is_on(*status, signals::alarm);
    const bool chain_closed = is_on(*status, signals::emergency_stop_ok);
    if (!alarm && chain_closed && is_on(*status, signals::cycle_start_enable)) return {};
    const std::chrono::nanoseconds waited = Clock::now() - since;
    if (waited >= options_.ready_timeout) {
      if (!chain_closed)
        return tl::unexpected{LogicFailure{.fault = LogicFault::emergency_stop, .after = waited}};
      if (alarm) return tl::unexpected{alarm_failure(since)};
      return tl::unexpected{LogicFailure{.fault = LogicFault::not_ready, .after = waited}};
    }
    std::this_thread::sleep_for(options_.poll_interval);
  }
}

tl::expected<void, LogicFailure> LogicTask::wait_tmf() {
  const auto end = Clock::now() + options_.tmf;
  while (!interrupted()) {
    const auto now = Clock::now();
    if (now >= end) return {};
    std::this_thread::sleep_until(std::min(end, now + options_.poll_interval));
  }
  return tl::unexpected{LogicFailure{.fault = LogicFault::interrupted}};
}

tl::expected<void, LogicFailure> LogicTask::wait_for_fin(bool on, Clock::time_point since) {
  const auto begin = Clock::now();
  auto on_since = begin;
  bool was_on = false;
  for (;;) {
    if (interrupted()) return tl::unexpected{LogicFailure{.fault = LogicFault::interrupted}};
    const auto status = read_status(begin);
    if (!status) return tl::unexpected{status.error()};
    const auto now = Clock::now();
    const std::chrono::nanoseconds waited = now - since;
    if (const auto healthy = check_health(*status, since); !healthy) return healthy;
    if (is_on(*status, signals::fin) != on) {
      was_on = false;
    } else if (!on) {
      return {};
    } else {
      if (!was_on) on_since = now;
      was_on = true;
      if (now - on_since >= options_.tfin) return {};
    }
    if (waited >= options_.fin_timeout) {
      return tl::unexpected{
          LogicFailure{.fault = on ? LogicFault::fin_missing : LogicFault::fin_stuck, .after = waited}};
    }
    std::this_thread::sleep_for(options_.poll_interval);
  }
}

/// Waits for a status that is not older than `not_before`: an older one may show what a write since then has
/// ended.
tl::expected<std::byte, LogicFailure> LogicTask::read_status(Clock::time_point not_before) {
  for (;;) {
    const auto status = link_.status();
    if (!status) return link_lost(status.error());
    if (status->read_at >= not_before) return status->signals;
    if (Clock::now() - status->read_at > options_.status_age_max) return link_lost(FxDriverError::no_answer);
    std::this_thread::sleep_for(options_.poll_interval);
  }
}

LogicFailure LogicTask::alarm_failure(Clock::time_point since) {
  return {.fault = LogicFault::alarm,
          .alarm_number = link_.read_word(signals::alarm_number).value_or(std::uint16_t{0}),
          .after = Clock::now() - since};
}

bool LogicTask::interrupted() const noexcept {
  return aborted_.load() || (stop_ != nullptr && stop_->load());
}

template <typename Notify>
void LogicTask::tell(const FunctionRequest& request, Notify notify) const {
  if (observer_ == nullptr) return;
  if (request.m) notify(FunctionKind::m, *request.m);
  if (request.s) notify(FunctionKind::s, *request.s);
  if (request.t) notify(FunctionKind::t, *request.t);
}

}  // namespace kernel_mocks
