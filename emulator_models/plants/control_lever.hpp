// The control lever: a position from -100 % (astern) to +100 % (ahead), shown by a 4 to 20 mA loop and by
// three switches, moved by a hand or, while the station gives the order, by a servo that follows the order.
//
// The loop's word counts 0.01 mA: 400 astern, 1200 stop, 2000 ahead. A broken wire gives 0, a short one 2200,
// both outside of what a sound loop can show (NAMUR NE 43: 3.6 to 20.5 mA carry a value).
// The switches change over at 2 %, inside of the dead band of 3 % that the word has in the PLC.
#pragma once

#include <chrono>
#include <cstdint>

namespace emulator_models::propulsion {

class ControlLever {
 public:
  static constexpr std::int32_t switch_point_permille = 20;
  /// From end to end.
  static constexpr std::chrono::nanoseconds servo_travel_time = std::chrono::seconds{4};
  static constexpr std::uint16_t broken_wire_word = 0;
  static constexpr std::uint16_t short_circuit_word = 2200;

  enum class Switch : std::uint8_t { sound, stuck_open, stuck_closed };

  /// The servo runs for `elapsed` if it was ordered to; then the noise has another value.
  void pass(std::chrono::nanoseconds elapsed) noexcept;
  /// @param on    a hand that moves the lever is stronger only while the servo is off
  /// @param word  position order, as the loop's word; out of range counts as the nearer end
  void order_servo(bool on, std::uint16_t word) noexcept;
  /// @param permille  -1000 to 1000; beyond is the end
  void move_to(std::int32_t permille) noexcept;

  [[nodiscard]] std::int32_t position_permille() const noexcept;
  [[nodiscard]] std::uint16_t word() const noexcept;
  [[nodiscard]] bool astern_closed() const noexcept;
  [[nodiscard]] bool stop_closed() const noexcept;
  [[nodiscard]] bool ahead_closed() const noexcept;

  void set_wire_broken(bool on) noexcept { wire_broken_ = on; }
  void set_short_circuit(bool on) noexcept { short_circuit_ = on; }
  /// The word is 10 too high and 10 too low by turns.
  void set_noisy(bool on) noexcept { noisy_ = on; }
  void set_servo_jammed(bool on) noexcept { servo_jammed_ = on; }
  void set_astern_switch(Switch state) noexcept { astern_ = state; }
  void set_stop_switch(Switch state) noexcept { stop_ = state; }
  void set_ahead_switch(Switch state) noexcept { ahead_ = state; }

 private:
  /// In nanoseconds of servo travel from the middle: exact for any steps of time.
  std::int64_t position_ns_ = 0;
  std::int64_t ordered_ns_ = 0;
  bool servo_on_ = false;
  bool servo_jammed_ = false;
  bool wire_broken_ = false;
  bool short_circuit_ = false;
  bool noisy_ = false;
  bool noise_is_high_ = false;
  Switch astern_ = Switch::sound;
  Switch stop_ = Switch::sound;
  Switch ahead_ = Switch::sound;
};

}  // namespace emulator_models::propulsion
