#include "kernel_mocks/logic_task.hpp"

#include <thread>

#include <fmt/format.h>

#include "kernel_mocks/plc_signals.hpp"
#include "protocol/check.hpp"

namespace kernel_mocks {
namespace {

double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

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

std::string to_string(const LogicFailure& failure) {
  switch (failure.fault) {
    case LogicFault::link_lost:
      return fmt::format("the link to the PLC failed: {}", to_string(failure.link));
    case LogicFault::alarm:
      return fmt::format("PLC alarm {} after {:.2f} s", failure.alarm_number, seconds(failure.after));
    case LogicFault::emergency_stop:
      return fmt::format("emergency stop after {:.2f} s", seconds(failure.after));
    case LogicFault::not_ready:
      return fmt::format("the PLC does not enable the cycle start (waited {:.2f} s)", seconds(failure.after));
    case LogicFault::fin_missing:
      return fmt::format("no FIN from the PLC within {:.2f} s", seconds(failure.after));
    case LogicFault::fin_stuck:
      return fmt::format("the PLC's FIN has not gone off within {:.2f} s", seconds(failure.after));
    case LogicFault::interrupted:
      return "interrupted";
  }
  return "unknown fault";
}

LogicTask::LogicTask(FxDriver& driver, const LogicTaskOptions& options, LogicTaskObserver* observer,
                     const std::atomic<bool>* stop)
    : driver_{driver}, options_{options}, observer_{observer}, stop_{stop} {}

tl::expected<void, LogicFailure> LogicTask::begin_program() {
  if (auto done = reset(); !done) return done;
  if (auto done = as_logic(driver_.force(signals::feed_hold_active, false)); !done) return done;
  if (auto done = wait_until_ready(); !done) return done;
  return as_logic(driver_.force(signals::program_running, true));
}

tl::expected<void, LogicFailure> LogicTask::raise(const FunctionRequest& request) {
  PLC_CHECK(request.m || request.s || request.t);
  if (auto done = wait_for_fin(false, Clock::now()); !done) return done;

  values_ = {request.m.value_or(0), request.s.value_or(values_[1]), request.t.value_or(values_[2])};
  if (auto done = as_logic(driver_.write_words(signals::m_code, values_)); !done) return done;

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
  return as_logic(driver_.force(signals::program_running, false));
}

tl::expected<void, LogicFailure> LogicTask::reset() {
  if (auto done = set_strobes(std::byte{0}); !done) return done;
  if (auto done = as_logic(driver_.force(signals::reset, true)); !done) return done;
  std::this_thread::sleep_for(options_.reset_pulse);
  if (auto done = as_logic(driver_.force(signals::reset, false)); !done) return done;
  return as_logic(driver_.force(signals::program_running, false));
}

tl::expected<void, LogicFailure> LogicTask::set_strobes(std::byte strobes) {
  // DEN is on in every state: the kernel gives functions only while nothing moves.
  const std::array bytes{strobes | signals::distribution_end};
  return as_logic(driver_.write_bytes(signals::strobe_byte, bytes));
}

tl::expected<void, LogicFailure> LogicTask::wait_until_ready() {
  const auto since = Clock::now();
  for (;;) {
    if (stop_asked_for()) return tl::unexpected{LogicFailure{.fault = LogicFault::interrupted}};
    const auto status = read_status();
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

tl::expected<void, LogicFailure> LogicTask::wait_for_fin(bool on, Clock::time_point since) {
  for (;;) {
    if (stop_asked_for()) return tl::unexpected{LogicFailure{.fault = LogicFault::interrupted}};
    const auto status = read_status();
    if (!status) return tl::unexpected{status.error()};
    const std::chrono::nanoseconds waited = Clock::now() - since;
    // An open chain drops everything at once; alarms that follow from it say less.
    if (!is_on(*status, signals::emergency_stop_ok)) {
      return tl::unexpected{LogicFailure{.fault = LogicFault::emergency_stop, .after = waited}};
    }
    if (is_on(*status, signals::alarm)) return tl::unexpected{alarm_failure(since)};
    if (is_on(*status, signals::fin) == on) return {};
    if (waited >= options_.fin_timeout) {
      return tl::unexpected{
          LogicFailure{.fault = on ? LogicFault::fin_missing : LogicFault::fin_stuck, .after = waited}};
    }
    std::this_thread::sleep_for(options_.poll_interval);
  }
}

tl::expected<std::byte, LogicFailure> LogicTask::read_status() {
  std::array<std::byte, 1> status{};
  if (const auto done = driver_.read_bytes(signals::status_byte, status); !done)
    return link_lost(done.error());
  return status.front();
}

LogicFailure LogicTask::alarm_failure(Clock::time_point since) {
  return {.fault = LogicFault::alarm,
          .alarm_number = driver_.read_word(signals::alarm_number).value_or(std::uint16_t{0}),
          .after = Clock::now() - since};
}

bool LogicTask::stop_asked_for() const noexcept { return stop_ != nullptr && stop_->load(); }

template <typename Notify>
void LogicTask::tell(const FunctionRequest& request, Notify notify) const {
  if (observer_ == nullptr) return;
  if (request.m) notify(FunctionKind::m, *request.m);
  if (request.s) notify(FunctionKind::s, *request.s);
  if (request.t) notify(FunctionKind::t, *request.t);
}

}  // namespace kernel_mocks
