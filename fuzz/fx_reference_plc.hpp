// An FX PLC as its programming port shows it, worked out a second time: the tables of addresses, of models and of latched
// devices as the manuals print them, the bytes of one kind behind those of another, and the rules of emulator_models/README.md. It shares no code
// with the emulator.
//
// Its program is
//
//   LD X0  ST Y0  LD D0  ST D1
//
// and a scan takes no time.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "fuzz/fx_reference_frame.hpp"
#include "protocol/fx/address_map.hpp"

namespace fuzz {

/// Bits that are on.
[[nodiscard]] std::size_t ones_in(std::span<const std::byte> bytes) noexcept;

class ReferencePlc {
 public:
  /// Points of X or Y, eight to a byte.
  using Points = std::array<std::uint8_t, 32>;

  explicit ReferencePlc(protocol::fx::Model model);

  /// @return the answer; empty: silence
  [[nodiscard]] std::string answer(std::string_view message);

  void set_run_switch(bool on) noexcept { run_switch_ = on; }
  void toggle_input(unsigned index) noexcept;
  /// @param now   of a clock that begins anywhere
  /// @param late  how much later than it was due the scan begins
  void scan(std::chrono::milliseconds now, std::chrono::milliseconds late);

  [[nodiscard]] const Points& terminal_outputs() const noexcept { return outputs_; }
  /// Ones in the whole memory: what was written where nobody looks shows here.
  [[nodiscard]] std::size_t ones_count() const noexcept { return ones_in(std::as_bytes(std::span{bytes_})); }

 private:
  enum Kind : std::uint8_t {
    x,
    y,
    m,
    special_m,
    s,
    t,
    c,
    t_value,
    c16_value,
    c32_value,
    d,
    special_d,
    kinds_count
  };
  /// Where the bytes of a kind begin: room for the model that has the most of it.
  static constexpr std::array<unsigned, kinds_count + 1> starts = [] {
    constexpr unsigned sizes[kinds_count] = {32, 32, 960, 64, 512, 64, 32, 1024, 400, 224, 16000, 1024};
    std::array<unsigned, kinds_count + 1> sums{};
    for (unsigned i = 0; i < kinds_count; ++i) sums[i + 1] = sums[i] + sizes[i];
    return sums;
  }();
  struct Row;
  struct Place {
    Kind kind;
    unsigned byte_index;
    std::uint8_t existing;  ///< bits that the model has
  };

  static bool is_bit(Kind kind) noexcept { return kind <= c; }
  [[nodiscard]] std::optional<Place> place_of(unsigned address, bool is_wide) const;
  [[nodiscard]] std::uint8_t existing_of(Kind kind, unsigned byte_index) const;
  [[nodiscard]] unsigned devices_of(Kind kind) const;
  [[nodiscard]] std::uint8_t read_only_bits(const Place& place) const;

  [[nodiscard]] std::string read(const ReferenceMessage& request);
  [[nodiscard]] std::string write(const ReferenceMessage& request);
  [[nodiscard]] std::string force(const ReferenceMessage& request);
  [[nodiscard]] std::string refuse(unsigned trouble);

  std::uint8_t& byte_at(Kind kind, unsigned index) { return bytes_[starts[kind] + index]; }
  [[nodiscard]] unsigned byte_at(Kind kind, unsigned index) const { return bytes_[starts[kind] + index]; }
  void set_bit(Kind kind, unsigned number, bool on);
  [[nodiscard]] bool bit(Kind kind, unsigned number) const;
  void set_word(Kind kind, unsigned number, unsigned value);
  [[nodiscard]] unsigned word(Kind kind, unsigned number) const;
  void clear(Kind kind, unsigned first, unsigned end);

  void set_run_flags(bool is_first_scan);
  void set_error(bool on);
  void clear_remote_orders();
  void stop();
  void show_clocks(std::chrono::milliseconds since_power_up);
  void latch_inputs();

  protocol::fx::Model model_;
  std::array<std::uint8_t, starts[kinds_count]> bytes_{};
  Points inputs_{};
  Points outputs_{};
  bool run_switch_ = true;
  bool run_switch_seen_ = true;
  bool is_running_ = false;
  bool has_error_ = false;
  std::optional<std::chrono::milliseconds> power_up_;
  std::chrono::milliseconds watchdog_limit_{0};
};

}  // namespace fuzz
