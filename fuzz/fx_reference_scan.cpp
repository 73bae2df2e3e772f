// The scan of the reference PLC.

#include "fuzz/fx_reference_plc.hpp"

#include <algorithm>

namespace fuzz {

using protocol::fx::Model;

namespace {

constexpr unsigned watchdog_error = 6105;
constexpr unsigned all = 0xFFFF;

}  // namespace

void ReferencePlc::scan(std::chrono::milliseconds now, std::chrono::milliseconds late) {
  if (is_running_ && late > watchdog_limit_) {
    is_running_ = false;
    stop();
    set_error(true);
    return;
  }
  const bool is_power_up = !power_up_;
  if (is_power_up) power_up_ = now;

  const bool was_running = is_running_;
  const bool is_switched = run_switch_ != run_switch_seen_;
  run_switch_seen_ = run_switch_;
  if (is_switched || is_power_up) is_running_ = run_switch_ || (was_running && !is_switched);
  if (bit(special_m, 37)) {
    clear_remote_orders();
    is_running_ = false;
  } else if (bit(special_m, 35) && bit(special_m, 36)) {
    is_running_ = true;
  }

  show_clocks(now - *power_up_);
  watchdog_limit_ = std::chrono::milliseconds{std::max(word(special_d, 0), 1U)};

  if (was_running && !is_running_) stop();
  if (!was_running && is_running_ && has_error_) set_error(false);
  set_run_flags(!was_running && is_running_);
  latch_inputs();
  if (!is_running_) return;
  set_bit(y, 0, bit(x, 0));
  set_word(d, 1, word(d, 0));
  outputs_ = {};
  if (!bit(special_m, 34)) std::copy_n(&byte_at(y, 0), outputs_.size(), outputs_.begin());
}

void ReferencePlc::show_clocks(std::chrono::milliseconds since_power_up) {
  constexpr unsigned periods_ms[] = {10, 100, 1000, 60'000};
  for (unsigned i = 0; i < 4; ++i) {
    const auto phase = static_cast<unsigned>(since_power_up.count() % periods_ms[i]);
    set_bit(special_m, 11 + i, phase >= periods_ms[i] / 2);
  }
  // The moment at which a real unit was captured; the wall clock stands still.
  constexpr unsigned calendar[] = {49, 31, 16, 8, 8, 2025, 5};
  for (unsigned i = 0; i < 7; ++i) set_word(special_d, 13 + i, calendar[i]);
}

void ReferencePlc::latch_inputs() {
  std::copy_n(inputs_.begin(), devices_of(x) / 8, &byte_at(x, 0));
  clear(d, 200, 208);  // the analog terminals, with nothing wired to them
}

void ReferencePlc::set_run_flags(bool is_first_scan) {
  set_bit(special_m, 0, is_running_);
  set_bit(special_m, 1, !is_running_);
  set_bit(special_m, 2, is_first_scan);
  set_bit(special_m, 3, !is_first_scan);
}

void ReferencePlc::clear_remote_orders() {
  for (unsigned number = 35; number <= 37; ++number) set_bit(special_m, number, false);
}

void ReferencePlc::set_error(bool on) {
  has_error_ = on;
  set_bit(special_m, 61, on);
  set_word(special_d, 61, on ? watchdog_error : 0);
  set_bit(special_m, 67, false);
  set_word(special_d, 67, 0);
  set_word(special_d, 69, 0);
  set_bit(special_m, 4, on);
  if (!on) return;
  set_run_flags(false);
  clear_remote_orders();
}

void ReferencePlc::stop() {
  outputs_ = {};
  if (bit(special_m, 33)) return;
  const bool is_small = model_ == Model::fx1s || model_ == Model::fx1n;
  const auto clear_kind = [this](Kind kind, unsigned first, unsigned end) {
    clear(kind, first, std::min(end, devices_of(kind)));
  };
  clear_kind(y, 0, all);
  clear_kind(m, 0, is_small ? 384 : 500);
  clear_kind(s, 0, is_small ? 0 : 500);
  for (const Kind kind : {t, t_value}) {
    clear_kind(kind, 0, 246);
    clear_kind(kind, 256, all);
  }
  for (const Kind kind : {c, c16_value}) clear_kind(kind, 0, is_small ? 16 : 100);
  clear_kind(c, 200, 220);
  clear_kind(c32_value, 0, 20);
  clear_kind(d, 0, is_small ? 128 : 200);
  clear_kind(d, 200, 218);  // wired to terminals: no memory
}

}  // namespace fuzz
